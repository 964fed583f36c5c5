// One program in our care, with all that it starts: signals that the user sends us reach it, its
// descendants are known even when they leave it, and when it is to end, it ends.
//
// Ctrl-C comes from the terminal to the program itself (it stays in our process group), so it is not
// sent a second time; a SIGINT sent to us by a process is handed on.
//
// Owned by one thread, which waits for signalFd() and calls tick() at least ten times a second.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "nodes/launch/child_process.hpp"

namespace mural::launch {

class ProgramSupervisor {
public:
    // Takes over SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGCHLD of this process, and its orphans.
    static Result<std::unique_ptr<ProgramSupervisor>> create();
    ProgramSupervisor(const ProgramSupervisor&) = delete;
    ProgramSupervisor& operator=(const ProgramSupervisor&) = delete;
    ~ProgramSupervisor();

    // Processes of ours (head, private display): neither waited for nor ended here, nor what is below.
    void leaveAlone(pid_t pid) { ours_.insert(pid); }

    Result<void> start(SpawnRequest request);
    [[nodiscard]] int signalFd() const { return signalFd_; }
    // Reads waiting signals, hands them on, collects ended processes, ends what is overdue.
    void tick();

    [[nodiscard]] bool started() const { return program_.started(); }
    [[nodiscard]] bool programRunning() { return program_.running(); }
    [[nodiscard]] int exitStatus() const { return program_.exitStatus(); }
    [[nodiscard]] std::string describeEnd() const { return program_.describeEnd(); }
    // The running ones of those: the program and its descendants.
    [[nodiscard]] std::vector<pid_t> processes() const;
    // Processes below us other than ours and those that only wait to be collected.
    [[nodiscard]] bool anyoneLeft() const;

    // Asks the program and its descendants to end (SIGTERM); after graceMs they are killed.
    void end(int64_t graceMs);
    [[nodiscard]] bool ending() const { return killAt_.has_value(); }
    // SIGTERM or SIGHUP came, or Ctrl-C while no program was running.
    [[nodiscard]] bool askedToStop() const { return stopSignal_ != 0; }
    [[nodiscard]] int stopSignal() const { return stopSignal_; }

private:
    explicit ProgramSupervisor(int signalFd) : signalFd_(signalFd) {}
    void readSignals();
    void signalAll(int number);
    void askNewcomers();
    [[nodiscard]] bool isOurs(pid_t session) const { return ours_.count(session) != 0; }

    int signalFd_;
    ChildProcess program_;
    std::set<pid_t> ours_;
    std::optional<Deadline> killAt_;
    std::set<pid_t> asked_; // to end, once each
    int stopSignal_ = 0;
};

} // namespace mural::launch
