#include "transport/rsp/io/socket_poller.hpp"

#include <algorithm>
#include <cerrno>
#include <sys/epoll.h>
#include <sys/timerfd.h>
#include <unistd.h>
#include <utility>

#include "common/base/clock.hpp"
#include "transport/system_error.hpp"

namespace mural::rsp {

namespace {

Error noDescriptor(const std::string& what) {
    return Error{"cannot " + what + ": " + errnoText(errno) + "; raise the limit of open files (ulimit -n)"};
}

bool control(int epoll, int operation, int fd) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = fd;
    return epoll_ctl(epoll, operation, fd, &event) == 0;
}

} // namespace

Result<SocketPoller> SocketPoller::open() {
    SocketPoller a;
    a.watched_ = FileDescriptor(epoll_create1(EPOLL_CLOEXEC));
    a.timer_ = FileDescriptor(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
    if (!a.watched_.valid() || !a.timer_.valid()) return noDescriptor("create a multicast group's timer");
    if (!control(a.watched_.get(), EPOLL_CTL_ADD, a.timer_.get()))
        return noDescriptor("watch a multicast group's timer");
    a.all_[a.count_++] = {a.timer_.get(), POLLIN, 0};
    return a;
}

Result<void> SocketPoller::add(int socket) {
    if (isWatched_ && !control(watched_.get(), EPOLL_CTL_ADD, socket))
        return noDescriptor("watch a multicast group's sockets");
    all_.at(count_++) = {socket, POLLIN, 0};
    return {};
}

void SocketPoller::wakeAt(int64_t ns) {
    itimerspec time{};
    const int64_t at = std::max<int64_t>(1, ns); // 0 would disarm the timer
    time.it_value.tv_sec = at / kNsPerS;
    time.it_value.tv_nsec = at % kNsPerS;
    timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &time, nullptr);
}

std::span<const int> SocketPoller::wait(int64_t timeoutNs) {
    const int64_t ns = std::max<int64_t>(0, timeoutNs);
    const timespec timeout{static_cast<time_t>(ns / kNsPerS), static_cast<long>(ns % kNsPerS)};
    found_ = 0;
    if (ppoll(all_.data(), count_, &timeout, nullptr) <= 0) return {};
    if (all_[0].revents != 0) { // the timer expired
        uint64_t times = 0;
        [[maybe_unused]] const auto fetched = read(timer_.get(), &times, sizeof times);
    }
    for (const pollfd& one : std::span(all_).subspan(1, count_ - 1))
        if (one.revents != 0) ready_[found_++] = one.fd;
    return found();
}

void SocketPoller::setWatched(bool on) {
    if (on == std::exchange(isWatched_, on)) return;
    for (const pollfd& one : std::span(all_).first(count_))
        control(watched_.get(), on ? EPOLL_CTL_ADD : EPOLL_CTL_DEL, one.fd);
}

} // namespace mural::rsp
