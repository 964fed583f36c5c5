#include "tools/mural/child_runs/bounded_run.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <utility>

#include "common/base/clock.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "nodes/launch/child_process.hpp"
#include "tools/mural/child_runs/end_processes.hpp"
#include "tools/mural/child_runs/interruption.hpp"

namespace mural::cli {

namespace {

constexpr int kTurnMs = 20;
constexpr int64_t kWatchMs = 250;
constexpr size_t kMaxLineBytes = 1000;
constexpr size_t kMaxMessages = 100;
constexpr size_t kMaxLastWords = 5;
constexpr size_t kReadsPerTurn = 64; // a program that prints without pause must not stop the loop
constexpr std::string_view kPrefix = "mural: ";

// One output of the command. Keeps some of its lines.
class Output {
public:
    explicit Output(BoundedOutcome& into) : into_(into) {}

    // Returns the descriptor for the command.
    Result<int> open() {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) return Error{"cannot create a pipe: " + std::string(std::strerror(errno))};
        own_ = FileDescriptor(ends[0]);
        its_ = FileDescriptor(ends[1]);
        fcntl(own_.get(), F_SETFL, O_NONBLOCK);
        return its_.get();
    }
    void started() { its_ = FileDescriptor(); }
    [[nodiscard]] int fd() const { return own_.get(); }

    // Reads the available bytes without waiting.
    void drain() {
        char part[65536];
        for (size_t i = 0; i < kReadsPerTurn; ++i) {
            const ssize_t n = own_.valid() ? read(own_.get(), part, sizeof part) : 0;
            if (n == 0) own_ = FileDescriptor(); // all writers have ended
            if (n <= 0) return;
            into_.outputBytes += n;
            take(std::string_view(part, static_cast<size_t>(n)));
        }
    }
    void finish() {
        drain();
        if (!line_.empty()) keep();
    }

private:
    void take(std::string_view bytes) {
        for (const char c : bytes) {
            if (c == '\n')
                keep();
            else if (line_.size() < kMaxLineBytes)
                line_ += c >= ' ' || c < 0 ? c : ' ';
        }
    }
    void keep() {
        std::string line = std::exchange(line_, {});
        if (line.starts_with(kPrefix)) {
            if (into_.messages.size() < kMaxMessages) into_.messages.push_back(line.substr(kPrefix.size()));
        } else if (line.find_first_not_of(' ') != std::string::npos) {
            into_.lastWords.push_back(std::move(line));
            if (into_.lastWords.size() > kMaxLastWords) into_.lastWords.erase(into_.lastWords.begin());
        }
    }

    BoundedOutcome& into_;
    FileDescriptor own_, its_;
    std::string line_;
};

} // namespace

Result<BoundedOutcome> runBounded(const BoundedCommand& command) {
    BoundedOutcome outcome;
    std::array<Output, 2> outputs{Output(outcome), Output(outcome)};
    const FileDescriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    launch::SpawnRequest request;
    request.file = command.words.front();
    request.arguments = command.words;
    request.environment = command.environment.entries();
    request.inputFd = nothing.get();
    for (auto [output, fd] : {std::pair{&outputs[0], &request.outputFd}, std::pair{&outputs[1], &request.errorFd}}) {
        const auto opened = output->open();
        if (!opened) return opened.error();
        *fd = opened.value();
    }
    request.ownSession = true; // Ctrl-C reaches this process, which ends the command in order
    request.signalWhenWeDie = SIGTERM;
    auto child = launch::ChildProcess::start(request);
    if (!child) return child.error();
    for (Output& output : outputs) output.started();

    const int64_t beganNs = monotonicNowNs();
    const Deadline total = Deadline::inMs(command.totalMs);
    Deadline limit = Deadline::inMs(command.startMs);
    int64_t begunNs = 0; // 0: not yet
    Deadline nextWatch = Deadline::inMs(kWatchMs);
    while (child->running() && !limit.passed() && !total.passed() && Interruption::signal() == 0) {
        pollfd waiting[2] = {{outputs[0].fd(), POLLIN, 0}, {outputs[1].fd(), POLLIN, 0}};
        poll(waiting, 2, kTurnMs);
        for (Output& output : outputs) output.drain();
        if (!nextWatch.passed()) continue;
        nextWatch = Deadline::inMs(kWatchMs);
        if (begunNs == 0 && command.hasBegun(child->pid())) {
            begunNs = monotonicNowNs();
            limit = Deadline::inMs(command.limitMs);
        }
        if (begunNs != 0 && command.watch)
            command.watch(child->pid(), static_cast<double>(monotonicNowNs() - begunNs) * 1e-9);
    }
    outcome.seconds = static_cast<double>(monotonicNowNs() - beganNs) * 1e-9;
    outcome.endedItself = !child->running();
    if (!outcome.endedItself) {
        // The outputs are still read: a command that prints much would otherwise block and not end.
        for (int time = 0; time < 2 && child->running(); ++time) {
            child->signal(SIGTERM);
            for (const Deadline grace = Deadline::inMs(command.graceMs); child->running() && !grace.passed();) {
                for (Output& output : outputs) output.drain();
                poll(nullptr, 0, kTurnMs);
            }
        }
        outcome.killed = child->running();
        child->end(Deadline::inMs(0));
    }
    killOrphans(command.display);
    for (Output& output : outputs) output.finish();
    outcome.exitStatus = child->exitStatus();
    outcome.end = child->describeEnd();
    return outcome;
}

} // namespace mural::cli
