#include "tools/mural/help/live_values.hpp"

#include <filesystem>
#include <fmt/format.h>

#include "balancer/compound/load_config.hpp"
#include "nodes/overlay/overlay_mode.hpp"
#include "tools/mural/ctl/command_words.hpp"
#include "tools/mural/ctl/control_client.hpp"
#include "tools/mural/stat/running_sessions.hpp"
#include "transport/discovery/discovery.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

// A person waits for the completion.
constexpr int64_t kSessionMs = 700;
constexpr int64_t kDiscoveryMs = 700;

std::vector<Candidate> wordsOf(std::initializer_list<const char*> words) {
    std::vector<Candidate> candidates;
    for (const char* word : words) candidates.push_back({word, {}});
    return candidates;
}

// Requests of completion to one session. They share a deadline.
class SessionQueries {
public:
    explicit SessionQueries(const std::string& controlPath)
        : deadline_(Deadline::inMs(kSessionMs)), client_(ControlClient::connect(controlPath, deadline_)) {}

    // Null: the session does not reply in time.
    Json result(const char* operation) {
        if (!client_) return {};
        auto reply = client_->request(operation, Json::object(), deadline_);
        return reply ? memberOf(*reply, "result") : Json();
    }

    // Returns the members `name` of the objects of a list.
    std::vector<Candidate> listed(const char* operation, const char* list, const char* name, const char* meaning) {
        std::vector<Candidate> candidates;
        const Json entries = memberOf(result(operation), list);
        for (const Json& entry : entries.is_array() ? entries : Json::array()) {
            const Json value = memberOf(entry, name);
            const std::string word = value.is_number_integer() ? fmt::format("{}", value.get<int64_t>())
                                     : value.is_string()       ? value.get<std::string>()
                                                               : std::string();
            if (!word.empty()) candidates.push_back({word, textOf(entry, meaning)});
        }
        return candidates;
    }

private:
    Deadline deadline_;
    Result<ControlClient> client_;
};

std::vector<Candidate> argumentValues(const NextWord& argument, SessionQueries& session) {
    if (argument.kind == "truth value") return wordsOf({"on", "off"});
    if (argument.word == "node") return session.listed("nodes", "nodes", "node", "where");
    if (argument.word == "canvas") return session.listed("layout", "canvases", "canvas", "layout");
    if (argument.word == "name") return session.listed("equalizers", "equalizers", "name", "kind");
    if (argument.word == "topic") return wordsOf({"status", "log", "events"});
    if (argument.word == "mode") {
        std::vector<Candidate> modes;
        for (const auto& mode : kOverlayModes) modes.push_back({mode.second, {}});
        return modes;
    }
    return {};
}

// Returns the control socket of the named session, or of the only one; empty: none, or several.
std::string controlPathOf(const std::string& session) {
    if (session.starts_with("/")) return session;
    auto sessions = findRunningSessions(session);
    return sessions && sessions->size() == 1 ? sessions->front().controlPath : std::string();
}

template <class Entries> std::vector<Candidate> namedEntries(const Entries& entries, const std::string& file) {
    std::vector<Candidate> candidates;
    for (const auto& entry : entries)
        if (entry.name) candidates.push_back({*entry.name, file});
    return candidates;
}

} // namespace

std::vector<Candidate> MachineValues::sessions() {
    std::vector<Candidate> candidates;
    auto sessions = findRunningSessions();
    if (!sessions) return candidates;
    for (const RunningSession& session : *sessions) // "mural-PID-RANDOM"
        candidates.push_back({session.name.substr(6, session.name.rfind('-') - 6), session.name});
    return candidates;
}

std::vector<Candidate> MachineValues::controlWords(const std::vector<std::string>& words, bool& takesFile) {
    std::vector<std::string> request = words;
    std::string session;
    if (!request.empty() && namesSession(request.front())) {
        session = request.front();
        request.erase(request.begin());
    }
    const std::string path = controlPathOf(session);
    std::vector<Candidate> candidates;
    if (path.empty()) return candidates;
    SessionQueries queries(path);
    for (const NextWord& next : nextWords(request, memberOf(queries.result("help"), "operations"))) {
        if (next.kind == "file") takesFile = true;
        if (next.kind.empty()) {
            candidates.push_back({next.word, next.meaning});
            continue;
        }
        for (Candidate& value : argumentValues(next, queries)) candidates.push_back(std::move(value));
    }
    return candidates;
}

std::vector<Candidate> MachineValues::daemons() {
    std::vector<Candidate> candidates;
    for (const FoundNode& node : discoverNodes({}, Deadline::inMs(kDiscoveryMs)).nodes)
        candidates.push_back({"@" + node.name, fmt::format("daemon on port {}", node.port)});
    return candidates;
}

std::vector<Candidate> MachineValues::interfaces() {
    std::vector<Candidate> candidates;
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator("/sys/class/net", failed))
        candidates.push_back({entry.path().filename().string(), {}});
    return candidates;
}

std::vector<Candidate> MachineValues::layouts(const std::string& file) {
    if (file.empty()) return {};
    return namedEntries(compound::loadConfig(file, compound::processEnvironment).file.config.layouts, file);
}

std::vector<Candidate> MachineValues::canvases(const std::string& file) {
    if (file.empty()) return {};
    return namedEntries(compound::loadConfig(file, compound::processEnvironment).file.config.canvases, file);
}

} // namespace mural::cli
