#include "transport/rsp/arrivals.hpp"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <sys/timerfd.h>

#include "common/clock.hpp"
#include "transport/system_error.hpp"

namespace mural::rsp {

namespace {

Error noDescriptor(const std::string& what) {
    return Error{"can't " + what + ": " + errnoText(errno) + "; raise the limit of open files (ulimit -n)"};
}

bool control(int epoll, int operation, int fd, uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.fd = fd;
    return epoll_ctl(epoll, operation, fd, &event) == 0;
}

} // namespace

Result<Arrivals> Arrivals::open() {
    Arrivals a;
    a.all_ = FileDescriptor(epoll_create1(EPOLL_CLOEXEC));
    a.watched_ = FileDescriptor(epoll_create1(EPOLL_CLOEXEC));
    a.timer_ = FileDescriptor(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
    if (!a.all_.valid() || !a.watched_.valid() || !a.timer_.valid()) return noDescriptor("make a multicast group's timer");
    // By edge: nobody has to fetch that it was time.
    if (!control(a.all_.get(), EPOLL_CTL_ADD, a.timer_.get(), uint32_t{EPOLLIN} | EPOLLET)) return noDescriptor("watch a multicast group's timer");
    if (!control(a.watched_.get(), EPOLL_CTL_ADD, a.all_.get(), EPOLLIN)) return noDescriptor("watch a multicast group's sockets");
    return a;
}

Result<void> Arrivals::add(int socket) {
    if (!control(all_.get(), EPOLL_CTL_ADD, socket, EPOLLIN)) return noDescriptor("watch a multicast group's sockets");
    return {};
}

void Arrivals::wakeAt(int64_t ns) {
    itimerspec time{};
    const int64_t at = std::max<int64_t>(1, ns); // 0 would turn it off
    time.it_value.tv_sec = at / kNsPerS;
    time.it_value.tv_nsec = at % kNsPerS;
    timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &time, nullptr);
}

// A timeout of its own costs less than to set a timer.
int Arrivals::waitFor(std::span<epoll_event> events, int64_t timeoutNs) {
    const auto most = static_cast<int>(events.size());
    if (timeoutNs <= 0) return epoll_wait(all_.get(), events.data(), most, 0);
    const timespec timeout{static_cast<time_t>(timeoutNs / kNsPerS), static_cast<long>(timeoutNs % kNsPerS)};
    if (fineTimeouts_) {
        const int count = epoll_pwait2(all_.get(), events.data(), most, &timeout, nullptr);
        if (count >= 0 || errno == EINTR) return count;
        fineTimeouts_ = false;
    }
    pollfd all{all_.get(), POLLIN, 0};
    ppoll(&all, 1, &timeout, nullptr);
    return epoll_wait(all_.get(), events.data(), most, 0);
}

std::span<const int> Arrivals::wait(int64_t timeoutNs) {
    std::array<epoll_event, 4> events{};
    const int count = waitFor(events, timeoutNs);
    size_t sockets = 0;
    for (int i = 0; i < count; ++i) {
        const int fd = events[static_cast<size_t>(i)].data.fd;
        if (fd != timer_.get()) ready_[sockets++] = fd;
    }
    return std::span(ready_).first(sockets);
}

void Arrivals::setWatched(bool on) { control(watched_.get(), EPOLL_CTL_MOD, all_.get(), on ? uint32_t{EPOLLIN} : 0u); }

} // namespace mural::rsp
