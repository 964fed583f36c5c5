// `mural stat`: takes two snapshots of the running sessions and prints rates; statistics of frames on request.
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <unistd.h>

#include "common/json/json_text.hpp"
#include "common/base/clock.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/stat/chrome_trace.hpp"
#include "tools/mural/stat/frame_summary.hpp"
#include "tools/mural/stat/prometheus_text.hpp"
#include "tools/mural/stat/running_sessions.hpp"
#include "tools/mural/stat/session_rates.hpp"

namespace mural::cli {

namespace {

constexpr double kOnceSeconds = 1.0; // between the snapshots of a single report
constexpr int kExitNone = 1;
constexpr std::chrono::milliseconds kPoll{200};       // between two requests for frames; the head keeps 600
constexpr std::chrono::milliseconds kMeansPoll{2000}; // the same for means; statistics stay on for 10 s
constexpr int kMeansFrames = 120;      // newest frames of a mean, so that fast programs cost no more than others
constexpr int64_t kNoFrameMs = 10'000; // limit for the next frame of a trace

int fail(const std::string& why, int status) {
    fmt::print(stderr, "mural stat: {}\n", why);
    return status;
}

int failNone(const StatOptions& options) {
    if (!options.session.empty())
        return fail("no session \"" + options.session + "\" of this user runs on this machine; mural stat lists all",
                    kExitNone);
    return fail("no session of this user runs on this machine; start one: mural run --tiles 2x2 -- PROGRAM", kExitNone);
}

void print(const std::vector<nlohmann::json>& sessions, bool asJson) {
    if (asJson) {
        fmt::print("{}\n", jsonText(nlohmann::json{{"sessions", sessions}}));
    } else {
        for (const auto& session : sessions)
            for (const std::string& line : statLines(session)) fmt::print("{}\n", line);
        if (sessions.empty()) fmt::print("no session\n");
    }
    std::fflush(stdout);
}

void sleepFor(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Adds the frames that have completed since the last call. newest: as in queryFrames(). Returns false if the session
// has ended.
Result<bool> collect(const RunningSession& session, SessionFrames& frames, int newest = 0) {
    do {
        auto reply = queryFrames(session.controlPath, frames.next, newest);
        if (!reply) return false;
        if (auto added = addReply(frames, *reply); !added) return added.error();
    } while (frames.hasMore);
    return true;
}

int reportTo(const std::string& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!file) return fail(path + ": " + std::strerror(errno) + "; choose a writable file", launch::kExitUsage);
    file << text << '\n';
    if (!file.flush()) return fail(path + ": " + std::strerror(errno) + "; free some space", launch::kExitUsage);
    return 0;
}

int writeTrace(const StatOptions& options) {
    auto sessions = findRunningSessions(options.session);
    if (!sessions) return fail(sessions.error().message, launch::kExitUsage);
    if (sessions->empty()) return failNone(options);
    if (sessions->size() > 1)
        return fail("several sessions run; name one: mural stat " + sessions->front().name + " --trace " +
                        options.traceFile,
                    launch::kExitUsage);
    SessionFrames frames;
    const auto wanted = static_cast<size_t>(options.frames);
    Deadline deadline = Deadline::inMs(kNoFrameMs);
    while (frames.frames.size() < wanted && !deadline.passed()) {
        const size_t had = frames.frames.size();
        auto alive = collect(sessions->front(), frames);
        if (!alive) return fail(alive.error().message, launch::kExitUsage);
        if (!*alive) break;
        if (frames.frames.size() > had) deadline = Deadline::inMs(kNoFrameMs);
        dropPartialBegin(frames);
        if (frames.frames.size() < wanted) std::this_thread::sleep_for(kPoll);
    }
    if (frames.frames.empty())
        return fail("the session drew no frame within " + std::to_string(kNoFrameMs / 1000) + " s", kExitNone);
    frames.frames.resize(std::min(frames.frames.size(), wanted));
    fmt::print("{} frames in {}; open it with https://ui.perfetto.dev\n", frames.frames.size(), options.traceFile);
    for (const std::string& line : summaryLines(summarize(frames.frames))) fmt::print("{}\n", line);
    return reportTo(options.traceFile, jsonText(chromeTrace(frames)));
}

// Collects the statistics of all sessions over some seconds, withOutputs: also the proofs of their outputs.
Result<std::vector<SessionFrames>> collectAll(const std::string& session, double seconds, bool withOutputs) {
    auto sessions = findRunningSessions(session);
    if (!sessions) return sessions.error();
    std::vector<SessionFrames> all(sessions->size());
    const Deadline deadline = Deadline::inMs(static_cast<int64_t>(seconds * 1000));
    const auto collectFrom = [&](size_t i, int newest) { return collect((*sessions)[i], all[i], newest); };
    for (size_t i = 0; i < all.size(); ++i) { // switches statistics on
        if (auto alive = collectFrom(i, 1); !alive) return alive.error();
        all[i].frames.clear(); // of the time before
    }
    for (size_t i = 0; withOutputs && i < all.size(); ++i)
        queryOutputs((*sessions)[i].controlPath); // requests the proofs
    do {
        std::this_thread::sleep_for(
            std::min<std::chrono::nanoseconds>(kMeansPoll, std::chrono::nanoseconds(deadline.leftNs())));
        for (size_t i = 0; i < all.size(); ++i)
            if (auto alive = collectFrom(i, kMeansFrames); !alive) return alive.error();
    } while (!deadline.passed());
    for (size_t i = 0; withOutputs && i < all.size(); ++i)
        if (auto outputs = queryOutputs((*sessions)[i].controlPath)) all[i].outputs = std::move(*outputs);
    std::erase_if(all, [](const SessionFrames& frames) { return !frames.status.is_object(); });
    return all;
}

int printMetrics(const StatOptions& options) {
    while (true) {
        auto sessions =
            collectAll(options.session, options.watchSeconds > 0 ? options.watchSeconds : kOnceSeconds, true);
        if (!sessions) return fail(sessions.error().message, launch::kExitUsage);
        if (sessions->empty() && options.watchSeconds == 0) return failNone(options);
        fmt::print("{}", prometheusText(*sessions));
        std::fflush(stdout);
        if (options.watchSeconds == 0) return 0;
    }
}

// Prints the rates of each session, and its stages. On a terminal each report replaces the previous one.
int watch(const StatOptions& options) {
    auto before = queryRunningSessions(options.session);
    if (!before) return fail(before.error().message, launch::kExitUsage);
    while (true) {
        auto sessions = collectAll(options.session, options.watchSeconds, false);
        if (!sessions) return fail(sessions.error().message, launch::kExitUsage);
        std::vector<nlohmann::json> now;
        for (const SessionFrames& frames : *sessions) now.push_back(frames.status);
        const std::vector<nlohmann::json> rated = withRates(*before, now);
        if (isatty(STDOUT_FILENO) != 0) fmt::print("\x1b[H\x1b[J");
        for (size_t i = 0; i < rated.size(); ++i) {
            for (const std::string& line : statLines(rated[i])) fmt::print("{}\n", line);
            for (const std::string& line : summaryLines(summarize((*sessions)[i].frames))) fmt::print("{}\n", line);
        }
        if (rated.empty()) fmt::print("no session\n");
        fmt::print("\n");
        std::fflush(stdout);
        *before = std::move(now);
    }
}

} // namespace

int statCommand(const StatOptions& options) {
    if (!options.traceFile.empty()) return writeTrace(options);
    if (options.asPrometheus) return printMetrics(options);
    if (options.watchSeconds > 0 && !options.asJson) return watch(options);
    auto before = queryRunningSessions(options.session);
    if (!before) return fail(before.error().message, launch::kExitUsage);
    if (before->empty() && options.watchSeconds == 0) return failNone(options);
    while (true) {
        sleepFor(options.watchSeconds > 0 ? options.watchSeconds : kOnceSeconds);
        auto now = queryRunningSessions(options.session);
        if (!now) return fail(now.error().message, launch::kExitUsage);
        print(withRates(*before, *now), options.asJson);
        if (options.watchSeconds == 0) return now->empty() ? fail("the session has ended", kExitNone) : 0;
        before = std::move(now);
    }
}

} // namespace mural::cli
