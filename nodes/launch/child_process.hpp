// One child process with an exact environment and exact descriptors. Owned by one thread. Destroying the object does
// not end the process: the owner ends it explicitly.
#pragma once

#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural::launch {

struct SpawnRequest {
    std::string file;                     // path to execute
    std::vector<std::string> arguments;   // including argv[0]
    std::vector<std::string> environment; // NAME=value
    std::vector<int> inheritedFds;        // descriptors inherited under the same number
    int inputFd = -1;                     // becomes standard input; -1: inherited
    int outputFd = -1;                    // becomes standard output; -1: inherited
    int errorFd = -1;                     // becomes standard error; -1: inherited
    bool ownSession = false;              // setsid: detaches it from the terminal's signals
    int signalWhenWeDie = 0;              // PR_SET_PDEATHSIG; 0: none
};

class ChildProcess {
public:
    ChildProcess() = default;
    // Reports errors of exec as well as of fork.
    static Result<ChildProcess> start(const SpawnRequest& request);
    // Takes over a child that was forked by other means.
    static ChildProcess adopt(pid_t pid);

    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] bool started() const { return pid_ > 0; }
    // Returns false once the process has ended, and collects its status.
    bool running();
    // The exit status or 128 + signal, as in a shell. Valid after running() has returned false.
    [[nodiscard]] int exitStatus() const { return exitStatus_; }
    // "exit status 1", "signal 9 (Killed)".
    [[nodiscard]] std::string describeEnd() const;
    void signal(int number);           // no effect after the end
    void signalGroup(int number);      // with ownSession: reaches all descendants, even after the child's end
    bool waitUntil(Deadline deadline); // true: it has ended
    // Sends SIGTERM, and SIGKILL after the deadline.
    void end(Deadline deadline);

private:
    pid_t pid_ = -1;
    bool running_ = false;
    bool ownSession_ = false;
    int exitStatus_ = 0;
    int endSignal_ = 0;
};

// Describes a status of waitpid(): "exit status 1", "signal 9 (Killed)".
std::string describeEnd(int waitStatus);

// Saves the signal mask and dispositions of this process for its children. Call before any signal is blocked or
// ignored; only the first call has an effect.
void rememberSignals();

} // namespace mural::launch
