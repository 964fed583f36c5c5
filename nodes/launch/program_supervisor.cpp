#include "nodes/launch/program_supervisor.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <sys/signalfd.h>
#include <unistd.h>

#include "nodes/launch/process_tree.hpp"

namespace mural::launch {

namespace {

constexpr int64_t kStopGraceMs = 3'000;

sigset_t watchedSignals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGCHLD}) sigaddset(&set, number);
    return set;
}

bool fromTerminal(const signalfd_siginfo& info) { return info.ssi_code == SI_KERNEL; }

} // namespace

Result<std::unique_ptr<ProgramSupervisor>> ProgramSupervisor::create() {
    rememberSignals();
    const sigset_t set = watchedSignals();
    sigprocmask(SIG_BLOCK, &set, nullptr);
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);
    adoptOrphans();
    const int fd = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
    if (fd < 0) return Error{"cannot create a descriptor for signals: " + std::string(std::strerror(errno))};
    return std::unique_ptr<ProgramSupervisor>(new ProgramSupervisor(fd));
}

ProgramSupervisor::~ProgramSupervisor() { close(signalFd_); }

Result<void> ProgramSupervisor::start(SpawnRequest request) {
    request.signalWhenWeDie = SIGTERM;
    auto child = ChildProcess::start(request);
    if (!child) return child.error();
    program_ = child.value();
    return {};
}

void ProgramSupervisor::tick() {
    readSignals();
    if (killAt_ && killAt_->passed()) signalAll(SIGKILL);
    if (killAt_ && !killAt_->passed()) stopNewProcesses();
}

void ProgramSupervisor::readSignals() {
    signalfd_siginfo info{};
    while (read(signalFd_, &info, sizeof info) == sizeof info) {
        const int number = static_cast<int>(info.ssi_signo);
        if (number == SIGCHLD) {
            program_.running(); // collects the status of program_
            std::set<pid_t> known = ownSessions_;
            known.insert(program_.pid());
            reapAdopted(known);
        } else if (number == SIGTERM || number == SIGHUP) {
            stopSignal_ = number;
            program_.signal(number);
            if (number == SIGTERM) terminated_.insert(program_.pid());
            end(kStopGraceMs);
        } else if (!programRunning()) {
            stopSignal_ = number; // no program is left that could receive the signal
        } else if (!fromTerminal(info)) {
            program_.signal(number);
        }
    }
}

std::vector<pid_t> ProgramSupervisor::processes() const {
    std::vector<pid_t> found;
    for (const ProcessFacts& p : descendantsOf(getpid(), ownSessions_)) {
        if (p.state != 'Z' && !isOwnSession(p.session)) found.push_back(p.pid);
    }
    return found;
}

bool ProgramSupervisor::anyoneLeft() const { return !processes().empty(); }

void ProgramSupervisor::end(int64_t graceMs) {
    stopNewProcesses();
    const Deadline wanted = Deadline::inMs(graceMs);
    if (!killAt_ || wanted.leftNs() < killAt_->leftNs()) killAt_ = wanted;
}

// Sends SIGTERM to processes that have not received it. A process may fork before it handles the signal, and its child
// receives none.
void ProgramSupervisor::stopNewProcesses() {
    for (const ProcessFacts& p : descendantsOf(getpid(), ownSessions_)) {
        if (p.state != 'Z' && !isOwnSession(p.session) && terminated_.insert(p.pid).second) kill(p.pid, SIGTERM);
    }
}

void ProgramSupervisor::signalAll(int number) {
    for (const ProcessFacts& p : descendantsOf(getpid(), ownSessions_)) {
        if (p.state != 'Z' && !isOwnSession(p.session)) kill(p.pid, number);
    }
}

} // namespace mural::launch
