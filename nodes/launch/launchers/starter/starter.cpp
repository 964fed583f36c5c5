#include "nodes/launch/launchers/starter/starter.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "common/ipc/file_descriptor.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/launchers/starter/munge_seal.hpp"
#include "nodes/launch/launchers/node_process.hpp"
#include "nodes/launch/launchers/starter/starter_protocol.hpp"

namespace mural::launch {
namespace {

// The head sends a line every 10 s. A head that is gone without an end of the input has no nodes either, because its
// connections to them have ended.
constexpr int64_t kSilenceMs = 30'000;
constexpr size_t kMaxLine = 1 << 20;

// The name of this host for the head; in a batch job, its name in the host list.
std::string hostName() {
    if (const char* const node = std::getenv("SLURMD_NODENAME"); node != nullptr && *node != '\0') return node;
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "unknown";
    return name.data();
}

FileDescriptor watchedSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGCHLD, SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, number);
    rememberSignals(); // nodes start with the original mask
    sigprocmask(SIG_BLOCK, &signals, nullptr);
    return FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
}

class Starter {
public:
    explicit Starter(const StarterOptions& options) : options_(options), host_(hostName()) {}

    int run() {
        signal(SIGPIPE, SIG_IGN);
        const FileDescriptor signals = watchedSignals();
        StarterReply hello;
        hello.kind = StarterReply::Kind::Hello;
        hello.version = options_.version;
        hello.build = options_.build;
        hello.host = host_;
        reply(hello);
        Deadline silence = Deadline::inMs(kSilenceMs);
        while (!isOver_) {
            std::array<pollfd, 2> polled{{{STDIN_FILENO, POLLIN, 0}, {signals.get(), POLLIN, 0}}};
            const int64_t waitMs = nodes_.empty() ? std::max<int64_t>(silence.leftNs() / kNsPerMs, 1) : -1;
            if (poll(polled.data(), polled.size(), static_cast<int>(waitMs)) < 0 && errno != EINTR) break;
            if (polled[1].revents != 0 && takeSignals(signals)) break;
            if (polled[0].revents != 0) {
                if (!readInput()) break;
                silence = Deadline::inMs(kSilenceMs);
            }
            reportEnds();
            if (nodes_.empty() && silence.passed()) break;
        }
        nodes_.clear(); // ends them
        return isUnsealed_ ? 0 : 1;
    }

private:
    // Returns true for a signal that ends the starter.
    static bool takeSignals(const FileDescriptor& signals) {
        signalfd_siginfo info{};
        bool ends = false;
        while (read(signals.get(), &info, sizeof info) == sizeof info)
            ends = ends || static_cast<int>(info.ssi_signo) != SIGCHLD;
        return ends;
    }

    // Returns false at the end of the input.
    bool readInput() {
        std::array<char, 4096> piece;
        const ssize_t n = read(STDIN_FILENO, piece.data(), piece.size());
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) return true;
        if (n <= 0) return false;
        input_.append(piece.data(), static_cast<size_t>(n));
        if (input_.size() > kMaxLine) return false; // no head sends such a line
        takeLines(input_);
        return true;
    }

    // Removes the complete lines from `text`.
    void takeLines(std::string& text) {
        size_t begin = 0;
        for (size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
            if (const auto request = starterRequestOf(std::string_view(text).substr(begin, end - begin)))
                take(*request);
        text.erase(0, begin);
    }

    void take(const StarterRequest& request) {
        const bool isMine = request.host == "*" || request.host == host_;
        switch (request.kind) {
        case StarterRequest::Kind::Start:
            if (isMine) start(request);
            return;
        case StarterRequest::Kind::Sealed:
            if (isMine) unseal(request.credential);
            return;
        case StarterRequest::Kind::Stop:
            nodes_.erase(request.id); // its end needs no report
            return;
        case StarterRequest::Kind::Alive: return;
        }
    }

    void unseal(const std::string& credential) {
        auto munge = MungeSeal::open();
        auto text = munge ? (*munge)->unseal(credential) : Result<std::string>(munge.error());
        if (text) return takeLines(text.value());
        StarterReply failed;
        failed.kind = StarterReply::Kind::Says;
        failed.text = "the secrets of the nodes of " + host_ + " cannot be read: " + text.error().message;
        reply(failed);
        isUnsealed_ = false;
        isOver_ = true;
    }

    void start(const StarterRequest& request) {
        NodeCommand command;
        command.arguments = {options_.binary.program, options_.binary.nodeWord(), "--as", request.name, "--connect",
                             request.endpoint};
        command.standardInput = request.secret + "\n";
        command.takeLine = [this, id = request.id](std::string_view line) {
            StarterReply says;
            says.kind = StarterReply::Kind::Says;
            says.id = id;
            says.text = line;
            reply(says);
        };
        auto started = NodeProcess::start(command);
        StarterReply answer;
        answer.id = request.id;
        answer.kind = started ? StarterReply::Kind::Started : StarterReply::Kind::Ended;
        if (started) answer.pid = (*started)->pid();
        if (!started) answer.text = started.error().message;
        reply(answer);
        if (started) nodes_[request.id] = std::move(*started);
    }

    void reportEnds() {
        for (auto it = nodes_.begin(); it != nodes_.end();) {
            const auto how = it->second->ended();
            if (!how) {
                ++it;
                continue;
            }
            StarterReply ended;
            ended.kind = StarterReply::Kind::Ended;
            ended.id = it->first;
            ended.text = *how;
            reply(ended);
            it = nodes_.erase(it);
        }
    }

    // Called by several threads.
    void reply(const StarterReply& message) {
        const std::string line = lineOf(message) + "\n";
        const std::lock_guard lock(writing_);
        for (size_t at = 0; at < line.size() && !isOver_;) {
            const ssize_t n = write(STDOUT_FILENO, line.data() + at, line.size() - at);
            if (n > 0) at += static_cast<size_t>(n);
            if (n < 0 && errno != EINTR) isOver_ = true; // the head is gone
        }
    }

    const StarterOptions options_;
    const std::string host_;
    std::string input_; // an incomplete line
    std::mutex writing_;
    std::atomic<bool> isOver_{false};
    bool isUnsealed_ = true;                            // no secret was unreadable
    std::map<int, std::unique_ptr<NodeProcess>> nodes_; // by id
};

} // namespace

int runStarter(const StarterOptions& options) { return Starter(options).run(); }

} // namespace mural::launch
