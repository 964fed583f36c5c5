#include "tools/mural/ctl/ctl_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>

#include "nodes/head/control/control_operations.hpp"
#include "nodes/head/control/nearest_names.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/ctl/command_words.hpp"
#include "tools/mural/ctl/control_client.hpp"
#include "tools/mural/ctl/reply_text.hpp"
#include "tools/mural/stat/running_sessions.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

constexpr int64_t kReplyPatienceMs = 25'000; // above the time of two operations, of which one is another client's
constexpr int kExitFailed = 1;

int ctlFailure(const std::string& why, int status) {
    fmt::print(stderr, "mural ctl: {}\n", why);
    return status;
}

// The session of the command line. The first word may name it.
struct Target {
    std::string path;
    std::string problem;
    int status = kExitFailed; // with a problem
};

Target targetOf(const std::string& word, const std::vector<RunningSession>& sessions) {
    if (word.starts_with("/")) return {word, ""};
    std::vector<std::string> names;
    std::string path;
    for (const RunningSession& session : sessions) {
        if (!word.empty() && !isCalled(session, word)) continue;
        names.push_back(session.name.substr(6, session.name.rfind('-') - 6));
        path = session.controlPath;
    }
    if (names.size() == 1) return {path, ""};
    if (names.size() > 1)
        return {"", "several sessions run: " + joinNames(names) + "; name one: mural ctl " + names.front() + " status",
                launch::kExitUsage};
    if (sessions.empty())
        return {"", "no session of this user runs on this machine; start one: mural run --tiles 2x2 -- PROGRAM"};
    return {"", "no session has the name " + word + "; mural stat lists the sessions"};
}

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

int printReply(const std::string& operation, const Json& reply, bool asJson) {
    const bool isOk = memberOf(reply, "ok") == true;
    if (asJson) fmt::print("{}\n", jsonLine(reply));
    if (isOk) {
        for (const std::string& line :
             asJson ? std::vector<std::string>() : replyLines(operation, memberOf(reply, "result")))
            fmt::print("{}\n", line);
        return 0;
    }
    const std::string code = textOf(reply, "code"), error = textOf(reply, "error");
    const bool isUsage = code == control_code::kBadArgument || code == control_code::kUnknownOperation;
    return ctlFailure(error.empty() ? "the session rejects the request" : error,
                      isUsage ? launch::kExitUsage : kExitFailed);
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
        return ctlFailure("a command is required, such as status; mural ctl help lists all (see mural ctl --help)",
                          launch::kExitUsage);
    auto sessions = findRunningSessions();
    if (!sessions) return ctlFailure(sessions.error().message, kExitFailed);
    const Target target = targetOf(session, *sessions);
    if (!target.problem.empty()) return ctlFailure(target.problem, target.status);
    const Deadline deadline = Deadline::inMs(kReplyPatienceMs);
    auto client = ControlClient::connect(target.path, deadline);
    if (!client) return ctlFailure(client.error().message, kExitFailed);
    auto help = client->request("help", Json::object(), deadline);
    if (!help) return ctlFailure(help.error().message, kExitFailed);
    auto request = requestOf(words, memberOf(memberOf(*help, "result"), "operations"));
    if (!request) return ctlFailure(request.error().message, launch::kExitUsage);
    auto reply = client->request(request->operation, request->arguments, deadline);
    if (!reply) return ctlFailure(reply.error().message, kExitFailed);
    const bool subscribes = request->operation == "subscribe" && memberOf(*reply, "ok") == true;
    if (subscribes) return printMessages(*client, arguments.asJson);
    return printReply(request->operation, *reply, arguments.asJson);
}

} // namespace mural::cli
