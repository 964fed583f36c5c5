// Who waits for what in a group, who sees to its sockets and timer meanwhile, and who is woken: leader and followers. A
// datagram's way is through one thread where it can be: the one that waits for it.
#include <algorithm>

#include "transport/rsp/group_state.hpp"

namespace mural::rsp {

namespace asio = boost::asio;

namespace {
constexpr int64_t kSliceNs = 100 * kNsPerMs; // how long a wait lasts at most before it looks again
} // namespace

// Each look at the clock is a system call: there are few.
bool Group::State::wait(std::unique_lock<std::mutex>& lock, Waits& what, Deadline deadline) {
    const int64_t leftNs = deadline.leftNs(kSliceNs);
    if (leftNs == 0) return false;
    int64_t nowNs = monotonicNowNs();
    const int64_t untilNs = nowNs + leftNs;
    if (leaderWaitsFor_) {
        ++what.sleeping;
        what.wake.wait_for(lock, std::chrono::nanoseconds(leftNs));
        --what.sleeping;
        return true;
    }
    leaderWaitsFor_ = &what;
    leaderCalled_ = false;
    arrivals_->setWatched(false);
    while (!leaderCalled_ && nowNs < untilNs) {
        leaderSleeps_ = true;
        lock.unlock();
        const auto sockets = arrivals_->wait(static_cast<int>((untilNs - nowNs + kNsPerMs - 1) / kNsPerMs));
        lock.lock();
        leaderSleeps_ = false;
        nowNs = monotonicNowNs();
        receive(sockets, nowNs);
    }
    leaderWaitsFor_ = nullptr;
    arrivals_->setWatched(true); // what has come meanwhile wakes the group's thread
    return true;
}

// The group's thread: it does what is to be done while nobody leads.
void Group::State::watch() {
    watched_->async_wait(asio::posix::stream_descriptor::wait_read, [this](const boost::system::error_code& failed) {
        if (failed) return;
        {
            const std::lock_guard lock(mutex);
            if (!leaderWaitsFor_) receive(arrivals_->wait(0), monotonicNowNs());
        }
        watch();
    });
}

// What is at these sockets, and what is due.
void Group::State::receive(std::span<const int> sockets, int64_t nowNs) {
    if (nowNs >= timerNs_) timerNs_ = INT64_MAX;
    for (const int descriptor : sockets) {
        UdpSocket& socket = descriptor == own_->descriptor() ? *own_ : *groupSocket_;
        socket.receive([&](std::span<std::byte> bytes, const SocketAddress&) {
            if (!opener_) return;
            const auto opened = opener_->open(bytes);
            if (!opened.empty()) core->inputDatagram(opened, nowNs);
        });
    }
    core->socketDropped(dropped());
    pump(nowNs);
}

void Group::State::pump(int64_t nowNs) {
    const int64_t next = core->tick(nowNs);
    outbox_->flush();
    armTimer(next);
    wakeWaiting();
}

// An earlier time stays: it costs a look, and to set one costs a system call.
void Group::State::armTimer(int64_t atNs) {
    if (atNs >= timerNs_) return;
    timerNs_ = atNs;
    arrivals_->wakeAt(atNs);
}

// The last thing before the lock is given back: who is woken wants it.
void Group::State::wakeWaiting() {
    const auto waitedFor = [&](const Waits& w) { return w.sleeping > 0 || leaderWaitsFor_ == &w; };
    if (const Sender* s = core->sender()) {
        if (waitedFor(room) && s->muchRoom()) wake(room);
        if (waitedFor(arrived) && s->allArrived()) wake(arrived);
    }
    for (const MemberId id : waitingForData) {
        const Receiver* r = core->receiver(id);
        if (r && !r->readable().empty()) return wake(data);
    }
}

// The leader sleeps at the sockets, not at a condition: the timer wakes it.
void Group::State::wake(Waits& what) {
    if (what.sleeping > 0) what.wake.notify_all();
    if (leaderWaitsFor_ != &what || leaderCalled_) return;
    leaderCalled_ = true;
    if (leaderSleeps_) armTimer(0);
}

void Group::State::wakeAll() {
    for (Waits* what : {&room, &arrived, &data}) wake(*what);
    changed.notify_all();
}

} // namespace mural::rsp
