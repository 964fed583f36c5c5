// One child process: started with an exact environment and exact descriptors, waited for by its pid.
// Owned by one thread. Destroying the object does not end the process: who starts it, ends it.
#pragma once

#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"

namespace mural::launch {

struct SpawnRequest {
    std::string file; // path to execute
    std::vector<std::string> arguments; // with argv[0]
    std::vector<std::string> environment; // NAME=value
    std::vector<int> keptFds;  // descriptors that the child inherits under the same number
    int inputFd = -1;          // becomes its standard input; -1: ours
    int outputFd = -1;         // becomes its standard output
    int errorFd = -1;          // becomes its standard error
    bool ownSession = false;   // setsid: signals of the terminal do not reach it
    int signalWhenWeDie = 0;   // PR_SET_PDEATHSIG; 0: none
};

class ChildProcess {
public:
    ChildProcess() = default;
    // Fails with the reason of exec, not only that of fork.
    static Result<ChildProcess> start(const SpawnRequest& request);
    // A child that was forked by other means.
    static ChildProcess adopt(pid_t pid);

    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] bool started() const { return pid_ > 0; }
    // False once it has ended; collects its status then.
    bool running();
    // As a shell counts: exit status, or 128 + signal. Only after running() has become false.
    [[nodiscard]] int exitStatus() const { return exitStatus_; }
    // "exit status 1", "signal 9 (Killed)".
    [[nodiscard]] std::string describeEnd() const;
    void signal(int number);      // nothing happens when it has ended
    void signalGroup(int number); // ownSession: everything that it started, also after it has ended
    bool waitUntil(Deadline deadline); // true: it has ended
    // SIGTERM, then SIGKILL when the deadline has passed.
    void end(Deadline deadline);

private:
    pid_t pid_ = -1;
    bool running_ = false;
    bool ownSession_ = false;
    int exitStatus_ = 0;
    int endSignal_ = 0;
};

// What the signal mask and dispositions were when this process began; children get them back.
// To be called before any signal is blocked or ignored; only the first call counts.
void rememberSignals();

} // namespace mural::launch
