#include "transport/tcp/tcp_race.hpp"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>
#include <vector>

#include "transport/system_error.hpp"

namespace mural {

namespace {

constexpr int64_t kBetweenAttemptsNs = 200 * kNsPerMs;
constexpr size_t kMaxAttempts = 16; // concurrent attempts

class Race {
public:
    explicit Race(std::span<const TcpAddress> addresses) : addresses_(addresses) {}

    [[nodiscard]] bool lost() const { return attempts_.empty() && started_ >= addresses_.size(); }
    [[nodiscard]] int lastCode() const { return lastCode_; }

    // Starts an attempt if none is in progress, or the last one is old enough.
    void startNext(int64_t nowNs) {
        const bool due = nowNs >= nextNs_ && attempts_.size() < kMaxAttempts;
        if (!due && !attempts_.empty()) return;
        const TcpAddress& to = addresses_[started_++ % addresses_.size()];
        nextNs_ = nowNs + kBetweenAttemptsNs;
        FileDescriptor socket(::socket(to.family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        if (socket.valid() &&
            (connect(socket.get(), to.get(), to.sizeBytes) == 0 || errno == EINPROGRESS || errno == EINTR))
            attempts_.push_back(std::move(socket));
        else
            failed(errno);
    }

    // Waits for an answer; returns an invalid descriptor without one.
    FileDescriptor answered(int64_t waitNs) {
        std::vector<pollfd> polled;
        for (const FileDescriptor& a : attempts_) polled.push_back({a.get(), POLLOUT, 0});
        const auto waitMs = static_cast<int>((waitNs + kNsPerMs - 1) / kNsPerMs);
        if (poll(polled.data(), polled.size(), waitMs) <= 0) return {};
        for (size_t i = polled.size(); i-- > 0;) {
            if (polled[i].revents == 0) continue;
            FileDescriptor socket = std::move(attempts_[i]);
            attempts_.erase(attempts_.begin() + static_cast<ptrdiff_t>(i));
            int code = 0;
            socklen_t sizeBytes = sizeof code;
            getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &code, &sizeBytes);
            // A connect to a free port of the own host can connect to itself.
            if (code == 0 && sameTcpAddress(localTcpAddress(socket.get()), peerTcpAddress(socket.get())))
                code = ECONNREFUSED;
            if (code == 0) return socket;
            failed(code);
        }
        return {};
    }

    [[nodiscard]] int64_t nextNs() const { return nextNs_; }

private:
    void failed(int code) {
        lastCode_ = code;
        if (started_ < addresses_.size()) nextNs_ = 0; // the next address starts immediately
    }

    std::span<const TcpAddress> addresses_;
    std::vector<FileDescriptor> attempts_;
    size_t started_ = 0;
    int64_t nextNs_ = 0;
    int lastCode_ = EHOSTUNREACH;
};

} // namespace

Result<FileDescriptor> connectRacing(std::span<const TcpAddress> addresses, Deadline deadline) {
    if (addresses.empty()) return Error{"the host has no address; check its name"};
    Race race(addresses);
    while (true) {
        race.startNext(monotonicNowNs());
        FileDescriptor socket = race.answered(
            deadline.leftNs(std::max<int64_t>(0, std::min(kBetweenAttemptsNs, race.nextNs() - monotonicNowNs()))));
        if (socket.valid()) return socket;
        if (race.lost()) return Error{errnoText(race.lastCode()) + "; check that the peer listens there"};
        if (deadline.passed()) return Error{"the deadline passed without a reply; check the address and the firewall"};
    }
}

} // namespace mural
