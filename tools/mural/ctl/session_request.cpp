#include "tools/mural/ctl/session_request.hpp"

#include <cstdio>
#include <fmt/format.h>

#include "nodes/head/control/control_operations.hpp"
#include "nodes/head/control/nearest_names.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/ctl/reply_text.hpp"
#include "tools/mural/stat/running_sessions.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

// Returns the path of the control socket.
Result<std::string> pathOf(const std::string& command, const std::string& word,
                           const std::vector<RunningSession>& sessions, int& status) {
    if (word.starts_with("/")) return word;
    std::vector<std::string> names;
    std::string path;
    for (const RunningSession& session : sessions) {
        if (!word.empty() && !isCalled(session, word)) continue;
        names.push_back(session.name.substr(6, session.name.rfind('-') - 6));
        path = session.controlPath;
    }
    if (names.size() == 1) return path;
    if (names.size() > 1) {
        status = launch::kExitUsage;
        return Error{"several sessions run: " + joinNames(names) + "; name one: mural " + command + " " +
                     names.front() + (command == "ctl" ? " status" : "")};
    }
    if (sessions.empty())
        return Error{"no session of this user runs on this machine; start one: mural run --tiles 2x2 -- PROGRAM"};
    return Error{"no session has the name " + word + "; mural stat lists the sessions"};
}

} // namespace

int requestFailure(const std::string& command, const std::string& why, int status) {
    fmt::print(stderr, "mural {}: {}\n", command, why);
    return status;
}

Result<std::string> controlPathOf(const std::string& command, const std::string& session, int& status) {
    status = kExitFailed;
    auto sessions = findRunningSessions();
    if (!sessions) return sessions.error();
    return pathOf(command, session, *sessions, status);
}

Result<ControlClient> connectToSession(const std::string& command, const std::string& session, Deadline deadline,
                                       int& status) {
    auto path = controlPathOf(command, session, status);
    if (!path) return path.error();
    return ControlClient::connect(*path, deadline);
}

int printReply(const std::string& command, const std::string& operation, const Json& reply, bool asJson) {
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
    return requestFailure(command, error.empty() ? "the session rejects the request" : error,
                          isUsage ? launch::kExitUsage : kExitFailed);
}

} // namespace mural::cli
