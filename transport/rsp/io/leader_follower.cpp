// Leader-follower polling: the first waiting thread (leader) polls sockets and timer for all; others sleep on condition
// variables. Where possible a datagram passes through a single thread, the one that waits for it.
#include <algorithm>
#include <array>
#include <utility>

#include "transport/rsp/io/group_state.hpp"

namespace mural::rsp {

namespace asio = boost::asio;

namespace {
// Time without a leader before the group's thread takes over: while this member's stream has unacknowledged data, whose
// losses need repair, and otherwise.
constexpr int64_t kTakeOverNs = 3 * kNsPerMs;
constexpr int64_t kTakeOverOfReadersNs = 8 * kNsPerMs;
constexpr unsigned kMaxPollsInARow = 3;       // consecutive reads of a socket; more would exceed the processor's cache
constexpr unsigned kPollSocketsEvery = 8;     // reads of a flowing socket between two polls
constexpr int64_t kCaughtUpNs = 6 * kNsPerMs; // longer than a reader's rest
constexpr int64_t kBetweenDroppedNs = 20 * kNsPerMs; // the writer is informed, but does not react
constexpr int64_t kMaxPauseNs = 2 * kNsPerMs;        // pause of a writer between two batches
} // namespace

bool Group::State::wait(std::unique_lock<std::mutex>& lock, Waits& what, Deadline deadline) {
    int64_t nowNs = quickNowNs();
    if (nowNs >= deadline.atNs()) return false;
    const int64_t untilNs = std::min(deadline.atNs(), nowNs + kSliceNs);
    if (leaderWaitsFor_) {
        ++what.sleeping;
        what.wake.wait_for(lock, std::chrono::nanoseconds(untilNs - nowNs));
        --what.sleeping;
        return true;
    }
    lead(what);
    while (!leaderCalled_ && nowNs < untilNs) {
        const int64_t rest = std::min(restNs(&what, nowNs), untilNs - nowNs);
        leaderUntilNs_ = std::min(untilNs, timerNs_);
        const int64_t timeoutNs = leaderUntilNs_ - nowNs - rest;
        leaderSleeps_ = true;
        if (rest > 0) takeOver_->postpone(nowNs + rest, takeOverNs());
        // A socket with remaining data, or in full flow, needs no poll; poll sometimes for the other socket.
        const bool flows = rest > 0 && &what == &data && !arrivals_->found().empty() && !ownIsInTransit();
        const bool knows = (moderation_.mayBeMore() || flows) && ++readsWithoutPoll_ % kPollSocketsEvery != 0;
        lock.unlock();
        if (rest > 0) sleepUntilNs(nowNs + rest);
        const auto sockets = knows ? arrivals_->found() : arrivals_->wait(timeoutNs);
        lock.lock();
        leaderSleeps_ = false;
        nowNs = quickNowNs();
        receive(sockets, nowNs);
    }
    endLead(nowNs);
    return true;
}

void Group::State::lead(const Waits& what) {
    leaderWaitsFor_ = &what;
    leaderCalled_ = false;
    if (std::exchange(isWatched_, false)) arrivals_->setWatched(false);
}

// A leader usually returns soon; waking the group's thread would only add contention if no other thread waits.
void Group::State::endLead(int64_t nowNs) {
    leaderWaitsFor_ = nullptr;
    if (room.sleeping + arrived.sleeping + data.sleeping > 0) return letWatch();
    takeOver_->push(nowNs, takeOverNs());
}

// Lets the group's thread wake for pending input.
void Group::State::letWatch() {
    if (std::exchange(isWatched_, true)) return;
    arrivals_->setWatched(true);
    publishTimer(timerNs_);
}

// Group's thread: takes over from a leader that does not return.
void Group::State::watchLeaders() {
    takeOverRings_->async_wait(asio::posix::stream_descriptor::wait_read,
                               [this](const boost::system::error_code& failed) {
                                   if (failed) return;
                                   {
                                       const std::lock_guard lock(mutex);
                                       if (takeOver_->rang(quickNowNs()) && !leaderWaitsFor_) letWatch();
                                   }
                                   watchLeaders();
                               });
}

// Group's thread: does the work while there is no leader.
void Group::State::watch() {
    watched_->async_wait(asio::posix::stream_descriptor::wait_read, [this](const boost::system::error_code& failed) {
        if (failed) return;
        int64_t rest = 0;
        {
            const std::lock_guard lock(mutex);
            if (!leaderWaitsFor_) {
                const int64_t nowNs = quickNowNs();
                receive(arrivals_->wait(0), nowNs);
                rest = restNs(nullptr, nowNs);
            }
        }
        if (rest == 0) return watch();
        restTimer_.expires_after(std::chrono::nanoseconds(rest));
        restTimer_.async_wait([this](const boost::system::error_code& ended) {
            if (!ended) watch();
        });
    });
}

int64_t Group::State::takeOverNs() const { return ownIsInTransit() ? kTakeOverNs : kTakeOverOfReadersNs; }

bool Group::State::ownIsInTransit() const {
    const Sender* own = core->sender();
    return own && !own->allArrived();
}

// Returns the time for which the polling thread may let datagrams accumulate. A writer limited by its rate needs no
// input before it may send.
int64_t Group::State::restNs(const Waits* what, int64_t nowNs) const {
    const Sender* s = core->sender();
    if (what == &room && s && s->canSend() && data.sleeping == 0 && timerNs_ != INT64_MAX)
        return std::clamp<int64_t>(timerNs_ - nowNs, 0, kMaxPauseNs);
    if (what == &arrived || what == &room || arrived.sleeping > 0 || room.sleeping > 0) return 0;
    return moderation_.restNs(nowNs);
}

// Reads these sockets and executes due work.
void Group::State::receive(std::span<const int> sockets, int64_t nowNs) {
    if (nowNs >= timerNs_) timerNs_ = INT64_MAX;
    if (nowNs >= publishedNs_) publishedNs_ = INT64_MAX;
    takeDatagrams(sockets, nowNs);
    pump(nowNs);
}

void Group::State::takeDatagrams(std::span<const int> sockets, int64_t nowNs) {
    ReceiveModeration::PollResult result;
    const bool waitsForAnswers = ownIsInTransit();
    for (const int descriptor : sockets) {
        const bool isOwn = descriptor == own_->descriptor();
        UdpSocket& socket = isOwn ? *own_ : *groupSocket_;
        // Consecutive reads cost less than reads with processing in between; the limit bounds the time under the lock.
        for (unsigned polls = 0; polls < kMaxPollsInARow; ++polls) {
            for (const UdpSocket::Datagram& d : socket.fetch(isOwn ? ReceiveBuffers{} : core->landing())) {
                if (!opener_) continue;
                const auto opened = opener_->open(d.bytes);
                if (opened.empty()) continue;
                ++result.datagrams;
                result.urgent = result.urgent || isUrgent(opened, waitsForAnswers);
                core->inputDatagram(opened, nowNs);
            }
            if (!socket.mayBeMore()) break;
        }
        result.mayBeMore = result.mayBeMore || socket.mayBeMore();
    }
    moderation_.onPolled(result, nowNs);
    polledNs_ = nowNs;
    if (nowNs - droppedQueriedNs_ >= kBetweenDroppedNs) {
        core->socketDropped(dropped());
        droppedQueriedNs_ = nowNs;
    }
}

// A running process polls often, so unread datagrams arrived just now.
bool Group::State::behind() {
    const int64_t nowNs = quickNowNs();
    if (moderation_.mayBeMore() || nowNs - polledNs_ < kCaughtUpNs) return moderation_.mayBeMore();
    std::array<int, 2> sockets{own_->descriptor()};
    if (groupSocket_) sockets[1] = groupSocket_->descriptor();
    takeDatagrams(std::span(sockets).first(groupSocket_ ? 2 : 1), nowNs);
    return moderation_.mayBeMore();
}

void Group::State::pump(int64_t nowNs) {
    const int64_t next = core->tick(nowNs);
    outbox_->flush();
    armTimer(next);
    diagnostics_.look(*core, nowNs);
    wakeWaiting();
}

// The leader checks the time itself; only sleeping threads need the timer.
void Group::State::armTimer(int64_t atNs) {
    timerNs_ = std::min(timerNs_, atNs);
    if (leaderSleeps_ ? timerNs_ < leaderUntilNs_ : isWatched_) publishTimer(timerNs_);
}

// An earlier timer stays set: it costs one poll, while setting it costs a system call.
void Group::State::publishTimer(int64_t atNs) {
    if (atNs >= publishedNs_) return;
    publishedNs_ = atNs;
    arrivals_->wakeAt(atNs);
}

// Runs last before the lock is released, because the woken thread needs it.
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

// The leader sleeps in poll, not on a condition variable: the timer wakes it.
void Group::State::wake(Waits& what) {
    if (what.sleeping > 0) what.wake.notify_all();
    if (leaderWaitsFor_ != &what || leaderCalled_) return;
    leaderCalled_ = true;
    if (leaderSleeps_) publishTimer(0);
}

void Group::State::wakeAll() {
    for (Waits* what : {&room, &arrived, &data}) wake(*what);
    changed.notify_all();
}

} // namespace mural::rsp
