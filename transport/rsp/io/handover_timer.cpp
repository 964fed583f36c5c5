#include "transport/rsp/io/handover_timer.hpp"

#include <cerrno>
#include <sys/timerfd.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "transport/system_error.hpp"

namespace mural::rsp {

Result<HandoverTimer> HandoverTimer::open() {
    HandoverTimer t;
    t.timer_ = FileDescriptor(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
    if (!t.timer_.valid())
        return Error{"cannot create a multicast group's timer: " + errnoText(errno) +
                     "; raise the limit of open files (ulimit -n)"};
    return t;
}

void HandoverTimer::push(int64_t nowNs, int64_t afterNs) {
    const int64_t leftNs = atNs_ == INT64_MIN ? 0 : atNs_ - nowNs;
    if (leftNs >= afterNs / 2 && leftNs <= afterNs) return;
    set(nowNs + afterNs);
}

void HandoverTimer::postpone(int64_t untilNs, int64_t afterNs) {
    if (atNs_ != INT64_MIN && atNs_ <= untilNs) set(untilNs + afterNs);
}

void HandoverTimer::set(int64_t atNs) {
    atNs_ = atNs;
    itimerspec time{};
    time.it_value.tv_sec = atNs_ / kNsPerS;
    time.it_value.tv_nsec = atNs_ % kNsPerS;
    timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &time, nullptr);
}

bool HandoverTimer::rang(int64_t nowNs) {
    uint64_t times = 0;
    [[maybe_unused]] const auto fetched = read(timer_.get(), &times, sizeof times);
    if (atNs_ == INT64_MIN || nowNs < atNs_) return false;
    atNs_ = INT64_MIN;
    return true;
}

} // namespace mural::rsp
