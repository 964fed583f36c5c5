// A run of one command in bounded time and memory, whatever the command prints. No process of it remains.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/launch/environment.hpp"

namespace mural::cli {

struct BoundedCommand {
    std::vector<std::string> words;
    launch::Environment environment;
    int64_t startMs = 0; // time until hasBegun() must be true
    int64_t limitMs = 0; // time from then on, after which it is ended
    int64_t totalMs = 0; // limit of both
    int64_t graceMs = 0; // time to end after each of two requests
    pid_t display = -1;  // process of a display that stays; -1: none
    // Whether the command with this pid has started the work. Called several times per second.
    std::function<bool(pid_t)> hasBegun;
    // Called several times per second from then on, with the pid and the time since then; may be empty.
    std::function<void(pid_t, double seconds)> watch;
};

struct BoundedOutcome {
    bool endedItself = false; // otherwise it was ended at its limit, or by an interruption
    bool killed = false;      // it did not end in order
    int exitStatus = 0;       // 128 + signal, as in a shell
    std::string end;          // "exit status 1", "signal 9 (Killed)"
    double seconds = 0;
    int64_t outputBytes = 0;            // of both outputs
    std::vector<std::string> messages;  // first lines of standard error that begin with "mural: ", without that
    std::vector<std::string> lastWords; // last other lines of both outputs
};

// Requires launch::adoptOrphans(), and an Interruption if signals shall end the run. Errors: the command cannot be
// executed.
Result<BoundedOutcome> runBounded(const BoundedCommand& command);

} // namespace mural::cli
