#include "tools/mural/stat/running_sessions.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/mural/ctl/control_client.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kPatienceMs = 5'000; // with a silent head

std::optional<nlohmann::json> querySession(const std::string& path) {
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    auto client = ControlClient::connect(path, deadline);
    if (!client) return {};
    auto reply = client->request("status", nlohmann::json::object(), deadline);
    if (!reply) return {};
    nlohmann::json state = memberOf(*reply, "result");
    if (!state.is_object()) return {};
    return state;
}

bool isOwn(const std::string& path) {
    struct stat facts {};
    return lstat(path.c_str(), &facts) == 0 && S_ISSOCK(facts.st_mode) && facts.st_uid == geteuid();
}

} // namespace

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

Result<std::vector<RunningSession>> findRunningSessions() {
    std::ifstream file("/proc/net/unix", std::ios::binary);
    if (!file)
        return Error{std::string("/proc/net/unix cannot be read: ") + std::strerror(errno) +
                     "; check that /proc is mounted"};
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::vector<RunningSession> sessions = sessionsIn(text);
    std::erase_if(sessions, [](const RunningSession& session) { return !isOwn(session.controlPath); });
    return sessions;
}

Result<std::vector<nlohmann::json>> queryRunningSessions() {
    auto sessions = findRunningSessions();
    if (!sessions) return sessions.error();
    std::vector<nlohmann::json> states;
    for (const RunningSession& session : *sessions)
        if (auto state = querySession(session.controlPath)) states.push_back(std::move(*state));
    return states;
}

} // namespace mural::cli
