#include "nodes/daemon/remote_command.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/environment.hpp"
#include "transport/system_error.hpp"

namespace mural {

namespace {

constexpr int kSliceMs = 50;
constexpr int64_t kOutputSendMs = 10'000;
constexpr int64_t kEndMs = 2'000;       // limit for a process whose head is gone
constexpr size_t kMaxWaiting = 1 << 20; // buffered bytes for standard input

// Sockets instead of pipes at this end: writes raise no signal and do not block.
struct Streams {
    FileDescriptor input, output, errors;          // ends of this process
    FileDescriptor itsInput, itsOutput, itsErrors; // the process's ends

    static Result<Streams> make() {
        Streams s;
        for (const auto& [ownEnd, childEnd] : {std::pair(&s.input, &s.itsInput), std::pair(&s.output, &s.itsOutput),
                                               std::pair(&s.errors, &s.itsErrors)}) {
            int ends[2];
            if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
                return Error{"cannot create a socket for a process: " + errnoText(errno)};
            *ownEnd = FileDescriptor(ends[0]);
            *childEnd = FileDescriptor(ends[1]);
            (void)fcntl(ends[0], F_SETFL, O_NONBLOCK);
        }
        return s;
    }
};

class Relay {
public:
    Relay(launch::ChildProcess process, Streams streams, ChannelSocket& channel)
        : process_(process), s_(std::move(streams)), channel_(channel) {}
    ~Relay() {
        s_.input = FileDescriptor();
        if (!process_.waitUntil(Deadline::inMs(kEndMs))) process_.signalGroup(SIGKILL);
        process_.end(Deadline::inMs(0));
    }

    Result<std::string> run(const std::atomic<bool>& stop) {
        while (!stop) {
            std::array<pollfd, 4> polled{{{channel_.descriptor(), POLLIN, 0},
                                          {s_.output.get(), POLLIN, 0},
                                          {s_.errors.get(), POLLIN, 0},
                                          {waiting_.empty() ? -1 : s_.input.get(), POLLOUT, 0}}};
            (void)poll(polled.data(), polled.size(), kSliceMs);
            auto came = polled[0].revents != 0 ? channel_.fetch() : Result<void>();
            // Input may have arrived with the command.
            if (auto r = takeInput(); !r) return r.error();
            if (!came) return came.error();
            feed();
            // Reads the state before the output, so that the last output is sent.
            const bool ended = !process_.running();
            if (auto r = sendOutput(s_.output, NodeMessageKind::Output); !r) return r.error();
            if (auto r = sendOutput(s_.errors, NodeMessageKind::Errors); !r) return r.error();
            if (ended) return end();
        }
        return Error{"this daemon is stopping"};
    }

private:
    Result<void> takeInput() {
        while (auto message = channel_.next()) {
            if (message->kind == NodeMessageKind::InputEnd) inputEnded_ = true;
            if (message->kind == NodeMessageKind::Input)
                waiting_.insert(waiting_.end(), message->body.begin(), message->body.end());
            if (waiting_.size() > kMaxWaiting) return Error{"the head sends data faster than the process reads it"};
        }
        return {};
    }
    void feed() {
        if (!s_.input.valid()) return;
        if (!waiting_.empty()) {
            const ssize_t n = ::send(s_.input.get(), waiting_.data(), waiting_.size(), MSG_NOSIGNAL);
            if (n > 0)
                waiting_.erase(waiting_.begin(), waiting_.begin() + n);
            else if (n < 0 && errno != EAGAIN && errno != EINTR)
                waiting_.clear(); // the process no longer reads
        }
        if (inputEnded_ && waiting_.empty()) s_.input = FileDescriptor();
    }
    Result<void> sendOutput(FileDescriptor& from, NodeMessageKind kind) {
        std::array<std::byte, 16'384> piece;
        while (from.valid()) {
            const ssize_t n = ::recv(from.get(), piece.data(), piece.size(), 0);
            if (n < 0 && errno == EINTR) continue;
            if (n < 0 && errno == EAGAIN) return {};
            if (n <= 0) {
                from = FileDescriptor();
                return {};
            }
            if (auto r = channel_.send({kind, {piece.begin(), piece.begin() + n}}, Deadline::inMs(kOutputSendMs)); !r)
                return r;
        }
        return {};
    }
    Result<std::string> end() {
        const std::string how = process_.describeEnd();
        NodeMessage message = textMessage(NodeMessageKind::Ended, how);
        message.body.insert(message.body.begin(), static_cast<std::byte>(process_.exitStatus()));
        (void)channel_.send(message, Deadline::inMs(kOutputSendMs));
        return how;
    }

    launch::ChildProcess process_;
    Streams s_;
    ChannelSocket& channel_;
    std::vector<std::byte> waiting_; // for its standard input
    bool inputEnded_ = false;
};

} // namespace

bool isAllowedCommand(const std::vector<std::string>& a) {
    if (a.size() == 1) return a[0] == "network-member";
    return a.size() == 5 && a[0] == "node" && a[1] == "--as" && !a[2].starts_with("-") && a[3] == "--connect" &&
           !a[4].starts_with("-");
}

void completeCommand(std::vector<std::string>& a, const std::string& peer) {
    if (a.size() == 5 && a[4].starts_with(":"))
        a[4] = (peer.find(':') == std::string::npos ? peer : "[" + peer + "]") + a[4];
}

Result<std::string> runRemoteCommand(const std::string& executable, const std::vector<std::string>& arguments,
                                     ChannelSocket& channel, const std::atomic<bool>& stop) {
    auto streams = Streams::make();
    if (!streams) return streams.error();
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    launch::SpawnRequest request;
    request.file = executable;
    request.arguments = {executable};
    request.arguments.insert(request.arguments.end(), arguments.begin(), arguments.end());
    request.environment = environment.entries();
    request.inputFd = streams->itsInput.get();
    request.outputFd = streams->itsOutput.get();
    request.errorFd = streams->itsErrors.get();
    request.ownSession = true;
    request.signalWhenWeDie = SIGKILL;
    auto process = launch::ChildProcess::start(request);
    if (!process) return process.error();
    for (FileDescriptor* childEnd : {&streams->itsInput, &streams->itsOutput, &streams->itsErrors})
        *childEnd = FileDescriptor();
    return Relay(*process, std::move(*streams), channel).run(stop);
}

} // namespace mural
