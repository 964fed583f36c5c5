#include "tools/mural/ctl/ctl_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>

#include "nodes/launch/program_check.hpp"
#include "tools/mural/ctl/command_words.hpp"
#include "tools/mural/ctl/control_client.hpp"
#include "tools/mural/ctl/session_request.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

constexpr const char* kCtl = "ctl";

// Prints the messages of a subscription until the session ends or a signal ends this process.
int printMessages(ControlClient& client, bool asJson) {
    while (true) {
        auto message = client.receive(Deadline::never());
        if (!message) return 0; // the session has ended
        const Json data = memberOf(*message, "data");
        if (asJson || !data.is_array()) fmt::print("{}\n", asJson ? jsonLine(*message) : jsonLine(data));
        for (const Json& entry : !asJson && data.is_array() ? data : Json::array()) {
            const std::string level = textOf(entry, "level"); // of a log line
            fmt::print("{}\n", level.empty() ? jsonLine(entry)
                                             : textOf(entry, "topic") + " " + level + ": " + textOf(entry, "text"));
        }
        std::fflush(stdout);
    }
}

} // namespace

void describeCtl(CLI::App& app, CtlArguments& arguments) {
    app.add_option("COMMAND", arguments.words, "[SESSION] and the words of an operation, such as status")
        ->type_name("");
    app.add_flag("--json", arguments.asJson, "print the reply of the session as one line of JSON");
}

int ctlCommand(const CtlArguments& arguments) {
    std::vector<std::string> words = arguments.words;
    std::string session;
    if (!words.empty() && namesSession(words.front())) {
        session = words.front();
        words.erase(words.begin());
    }
    if (words.empty())
        return requestFailure(kCtl,
                              "a command is required, such as status; mural ctl help lists all (see mural ctl --help)",
                              launch::kExitUsage);
    const Deadline deadline = Deadline::inMs(kReplyPatienceMs);
    int status = 0;
    auto client = connectToSession(kCtl, session, deadline, status);
    if (!client) return requestFailure(kCtl, client.error().message, status);
    auto help = client->request("help", Json::object(), deadline);
    if (!help) return requestFailure(kCtl, help.error().message, kExitFailed);
    auto request = requestOf(words, memberOf(memberOf(*help, "result"), "operations"));
    if (!request) return requestFailure(kCtl, request.error().message, launch::kExitUsage);
    auto reply = client->request(request->operation, request->arguments, deadline);
    if (!reply) return requestFailure(kCtl, reply.error().message, kExitFailed);
    const bool subscribes = request->operation == "subscribe" && memberOf(*reply, "ok") == true;
    if (subscribes) return printMessages(*client, arguments.asJson);
    return printReply(kCtl, request->operation, *reply, arguments.asJson);
}

} // namespace mural::cli
