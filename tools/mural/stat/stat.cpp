// `mural stat`: takes two snapshots of the running sessions and prints rates.
#include <cerrno>
#include <chrono>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "nodes/launch/program_check.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/stat/running_sessions.hpp"
#include "tools/mural/stat/session_rates.hpp"

namespace mural::cli {

namespace {

constexpr double kOnceSeconds = 1.0; // between the snapshots of a single report
constexpr int kExitNone = 1;

int fail(const std::string& why, int status) {
    fmt::print(stderr, "mural stat: {}\n", why);
    return status;
}

void print(const std::vector<nlohmann::json>& sessions, bool asJson) {
    if (asJson) {
        fmt::print("{}\n", nlohmann::json{{"sessions", sessions}}.dump());
    } else {
        for (const auto& session : sessions)
            for (const std::string& line : statLines(session)) fmt::print("{}\n", line);
        if (sessions.empty()) fmt::print("no session\n");
    }
    std::fflush(stdout);
}

} // namespace

int statCommand(const StatOptions& options) {
    auto before = queryRunningSessions();
    if (!before) return fail(before.error().message, launch::kExitUsage);
    if (before->empty() && options.watchSeconds == 0)
        return fail("no session of this user runs on this machine; start one: mural run --tiles 2x2 -- PROGRAM",
                    kExitNone);
    while (true) {
        const double seconds = options.watchSeconds > 0 ? options.watchSeconds : kOnceSeconds;
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        auto now = queryRunningSessions();
        if (!now) return fail(now.error().message, launch::kExitUsage);
        print(withRates(*before, *now), options.asJson);
        if (options.watchSeconds == 0) return now->empty() ? fail("the session has ended", kExitNone) : 0;
        before = std::move(now);
        if (!options.asJson) fmt::print("\n");
    }
}

} // namespace mural::cli
