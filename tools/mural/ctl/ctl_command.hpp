// `mural ctl`: sends one request to a running session and prints the reply.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace mural::cli {

inline constexpr const char* kCtlFooter =
    "Examples:\n  mural ctl help                            the operations of the only session\n  mural ctl 4711 "
    "status "
    "                    state of the session of mural run 4711\n  mural ctl restart-node 1\n  mural ctl log-level "
    "rsp:debug\n  mural ctl equalizer wall freeze on\n  mural ctl subscribe log                   log lines until "
    "Ctrl-C\n  mural ctl --json report\n\nSESSION: the number that mural stat shows, the session's name, or the path "
    "of "
    "its control socket; it may be\nleft out if only one session runs. Words after -- are no options: mural ctl "
    "equalizer wall set boost -- -1\nExit status: 0; 1 if no session replies or the operation fails; 2 for a bad "
    "argument.";

struct CtlArguments {
    std::vector<std::string> words; // [SESSION] COMMAND...
    bool asJson = false;
};

void describeCtl(CLI::App& app, CtlArguments& arguments);
int ctlCommand(const CtlArguments& arguments);

} // namespace mural::cli
