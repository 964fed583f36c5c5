#include "tools/mural/stat/running_sessions.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/mural/ctl/control_client.hpp"

namespace mural::cli {

namespace {

// With a silent head. Another client's operation may last nine seconds, such as stop-node.
constexpr int64_t kPatienceMs = 15'000;

// Returns the result of an operation. Empty: the session does not reply, or rejects the request.
std::optional<nlohmann::json> querySession(const std::string& path, const char* operation,
                                           const nlohmann::json& arguments) {
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    auto client = ControlClient::connect(path, deadline);
    if (!client) return {};
    auto reply = client->request(operation, arguments, deadline);
    if (!reply) return {};
    nlohmann::json result = memberOf(*reply, "result");
    if (!result.is_object()) return {};
    return result;
}

bool isOwn(const std::string& path) {
    struct stat facts {};
    return lstat(path.c_str(), &facts) == 0 && S_ISSOCK(facts.st_mode) && facts.st_uid == geteuid();
}

} // namespace

bool isCalled(const RunningSession& session, const std::string& word) {
    return session.name == word || session.name.starts_with("mural-" + word + "-");
}

std::vector<RunningSession> sessionsIn(const std::string& unixSockets) {
    // The path ends the line. The words before it contain no '/'.
    static const std::regex kPath("^[^/]* (/.*/(mural-[0-9]+-[0-9a-f]{16})/control)$");
    std::map<std::string, std::string> paths; // a session appears once per connection
    std::istringstream lines(unixSockets);
    std::smatch found;
    for (std::string line; std::getline(lines, line);)
        if (std::regex_match(line, found, kPath)) paths[found[2]] = found[1];
    std::vector<RunningSession> sessions;
    for (const auto& [name, path] : paths) sessions.push_back({name, path});
    return sessions;
}

Result<std::vector<RunningSession>> findRunningSessions(const std::string& session) {
    std::ifstream file("/proc/net/unix", std::ios::binary);
    if (!file)
        return Error{std::string("/proc/net/unix cannot be read: ") + std::strerror(errno) +
                     "; check that /proc is mounted"};
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::vector<RunningSession> sessions = sessionsIn(text);
    std::erase_if(sessions, [&](const RunningSession& s) {
        return (!session.empty() && !isCalled(s, session)) || !isOwn(s.controlPath);
    });
    return sessions;
}

Result<std::vector<nlohmann::json>> queryRunningSessions(const std::string& session) {
    auto sessions = findRunningSessions(session);
    if (!sessions) return sessions.error();
    std::vector<nlohmann::json> states;
    for (const RunningSession& s : *sessions)
        if (auto state = querySession(s.controlPath, "status", nlohmann::json::object()))
            states.push_back(std::move(*state));
    return states;
}

std::optional<nlohmann::json> queryFrames(const std::string& controlPath, uint64_t sinceFrame, int newest) {
    nlohmann::json arguments{{"since", sinceFrame}};
    if (newest > 0) arguments["newest"] = newest;
    return querySession(controlPath, "frames", arguments);
}

std::optional<nlohmann::json> queryOutputs(const std::string& controlPath) {
    return querySession(controlPath, "outputs", nlohmann::json::object());
}

} // namespace mural::cli
