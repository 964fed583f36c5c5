// `mural change`: another division of the work in a running session, by the options of `mural run`.
#pragma once

#include <string>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

inline constexpr const char* kChangeFooter =
    "Examples:\n  mural change --tiles 2x2 --dry-run        the nodes that would start and end\n  mural change "
    "--balance auto --local-nodes 4\n  mural change 4711 --db 2\n  mural change --config wall.eqc            the file "
    "as it is now; unchanged nodes continue\n  mural change --undo                       back to the options before\n"
    "  mural change --db 4 --revert-after 15     back after 15 s unless mural ctl keep comes first\n"
    "\nThe options replace all options of the session that divide the work, as if it began with them. The change "
    "happens\nbetween two frames, or not at all. SESSION: as for mural ctl.\nExit status: 0; 1 if no session replies "
    "or nothing has changed; 2 for a bad argument.";

struct ChangeArguments {
    std::string session; // empty: the only one
    RunArguments options;
    bool isDryRun = false, isUndo = false, asJson = false;
    int64_t revertAfterSeconds = 0; // 0: the change stays
    CLI::App* app = nullptr;        // has parsed the options
};

void describeChange(CLI::App& app, ChangeArguments& arguments);
int changeCommand(const ChangeArguments& arguments);

} // namespace mural::cli
