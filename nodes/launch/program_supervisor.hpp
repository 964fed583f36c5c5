// Supervises one program and its descendants: forwards signals, tracks descendants that leave the process group, and
// ends all of them on request.
//
// The program stays in the process group of this process, so the terminal sends Ctrl-C to it directly. This class then
// does not send it again. It forwards a SIGINT from another process.
//
// Owned by one thread, which waits for signalFd() and calls tick() at least ten times per second.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"

namespace mural::launch {

class ProgramSupervisor {
public:
    // Takes over SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGCHLD of this process, and its orphans.
    static Result<std::unique_ptr<ProgramSupervisor>> create();
    ProgramSupervisor(const ProgramSupervisor&) = delete;
    ProgramSupervisor& operator=(const ProgramSupervisor&) = delete;
    ~ProgramSupervisor();

    // Excludes a process of Mural (head, private display) and its descendants: they have other owners.
    void leaveAlone(pid_t pid) { ownSessions_.insert(pid); }

    Result<void> start(SpawnRequest request);
    [[nodiscard]] int signalFd() const { return signalFd_; }
    // Processes pending signals, forwards them, reaps ended processes, and kills those past their deadline.
    void tick();

    [[nodiscard]] bool started() const { return program_.started(); }
    [[nodiscard]] bool programRunning() { return program_.running(); }
    [[nodiscard]] int exitStatus() const { return program_.exitStatus(); }
    [[nodiscard]] std::string describeEnd() const { return program_.describeEnd(); }
    // The running processes: the program and its descendants.
    [[nodiscard]] std::vector<pid_t> processes() const;
    // True if descendants other than excluded processes and zombies exist.
    [[nodiscard]] bool anyoneLeft() const;

    // Sends SIGTERM to the program and its descendants, and SIGKILL after graceMs.
    void end(int64_t graceMs);
    [[nodiscard]] bool ending() const { return killAt_.has_value(); }
    // True after SIGTERM or SIGHUP, or after Ctrl-C without a running program.
    [[nodiscard]] bool stopRequested() const { return stopSignal_ != 0; }
    [[nodiscard]] int stopSignal() const { return stopSignal_; }

private:
    explicit ProgramSupervisor(int signalFd) : signalFd_(signalFd) {}
    void readSignals();
    void signalAll(int number);
    void stopNewProcesses();
    [[nodiscard]] bool isOwnSession(pid_t session) const { return ownSessions_.count(session) != 0; }

    int signalFd_;
    ChildProcess program_;
    std::set<pid_t> ownSessions_;
    std::optional<Deadline> killAt_;
    std::set<pid_t> terminated_; // processes that have received SIGTERM, once each
    int stopSignal_ = 0;
};

} // namespace mural::launch
