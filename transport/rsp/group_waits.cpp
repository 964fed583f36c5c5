// Who waits for what in a group, who sees to its sockets and timer meanwhile, and who is woken: leader and followers. A
// datagram's way is through one thread where it can be: the one that waits for it.
#include <algorithm>
#include <array>
#include <utility>

#include "transport/rsp/group_state.hpp"

namespace mural::rsp {

namespace asio = boost::asio;

namespace {
// After which the group's thread does what no leader has come back for: where a stream of ours is on its way, whose losses
// are to be mended, and else.
constexpr int64_t kTakeOverNs = 3 * kNsPerMs;
constexpr int64_t kTakeOverOfReadersNs = 8 * kNsPerMs;
constexpr unsigned kMostLooksInARow = 3; // at a socket, before anything else is done; what they bring is in the processor's cache when it is read
constexpr unsigned kAsksSocketsEvery = 8; // times that a leader looks at what it knows to flow
constexpr int64_t kCaughtUpNs = 6 * kNsPerMs; // longer than a reader rests
constexpr int64_t kBetweenDroppedNs = 20 * kNsPerMs; // the writer is told, and does nothing by it
constexpr int64_t kMostPauseNs = 2 * kNsPerMs; // of a writer between two batches
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
        if (rest > 0) takeOver_->keepBehind(nowNs + rest, takeOverNs());
        // Where something was left behind, or flows, nobody need ask for it; now and then all the same, for the other socket.
        const bool flows = rest > 0 && &what == &data && !arrivals_->found().empty() && !ownIsOnItsWay();
        const bool knows = (moderation_.mayBeMore() || flows) && ++looksUnasked_ % kAsksSocketsEvery != 0;
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

// Who has led comes back soon, most of the time; the group's thread would only be in its way, where no other one waits.
void Group::State::endLead(int64_t nowNs) {
    leaderWaitsFor_ = nullptr;
    if (room.sleeping + arrived.sleeping + data.sleeping > 0) return letWatch();
    takeOver_->push(nowNs, takeOverNs());
}

// What has come meanwhile wakes the group's thread.
void Group::State::letWatch() {
    if (std::exchange(isWatched_, true)) return;
    arrivals_->setWatched(true);
    tellTime(timerNs_);
}

// The group's thread: it takes over from leaders that did not come back.
void Group::State::watchLeaders() {
    takeOverRings_->async_wait(asio::posix::stream_descriptor::wait_read, [this](const boost::system::error_code& failed) {
        if (failed) return;
        {
            const std::lock_guard lock(mutex);
            if (takeOver_->rang(quickNowNs()) && !leaderWaitsFor_) letWatch();
        }
        watchLeaders();
    });
}

// The group's thread: it does what is to be done while nobody leads.
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

int64_t Group::State::takeOverNs() const { return ownIsOnItsWay() ? kTakeOverNs : kTakeOverOfReadersNs; }

bool Group::State::ownIsOnItsWay() const {
    const Sender* own = core->sender();
    return own && !own->allArrived();
}

// Who sees to the sockets, and waits for this, may let datagrams gather so long. A writer that may not send yet, for its rate,
// need not hear of anything before it may.
int64_t Group::State::restNs(const Waits* what, int64_t nowNs) const {
    const Sender* s = core->sender();
    if (what == &room && s && s->canSend() && data.sleeping == 0 && timerNs_ != INT64_MAX) return std::clamp<int64_t>(timerNs_ - nowNs, 0, kMostPauseNs);
    if (what == &arrived || what == &room || arrived.sleeping > 0 || room.sleeping > 0) return 0;
    return moderation_.restNs(nowNs);
}

// What is at these sockets, and what is due.
void Group::State::receive(std::span<const int> sockets, int64_t nowNs) {
    if (nowNs >= timerNs_) timerNs_ = INT64_MAX;
    if (nowNs >= toldNs_) toldNs_ = INT64_MAX;
    takeDatagrams(sockets, nowNs);
    pump(nowNs);
}

void Group::State::takeDatagrams(std::span<const int> sockets, int64_t nowNs) {
    ReceiveModeration::Look look;
    const bool waitsForAnswers = ownIsOnItsWay();
    for (const int descriptor : sockets) {
        const bool isOwn = descriptor == own_->descriptor();
        UdpSocket& socket = isOwn ? *own_ : *groupSocket_;
        // Looks in a row cost less than looks with all that is done behind each; others may want the lock.
        for (unsigned looks = 0; looks < kMostLooksInARow; ++looks) {
            for (const UdpSocket::Datagram& d : socket.fetch(isOwn ? Landing{} : core->landing())) {
                if (!opener_) continue;
                const auto opened = opener_->open(d.bytes);
                if (opened.empty()) continue;
                ++look.datagrams;
                look.urgent = look.urgent || isUrgent(opened, waitsForAnswers);
                core->inputDatagram(opened, nowNs);
            }
            if (!socket.mayBeMore()) break;
        }
        look.mayBeMore = look.mayBeMore || socket.mayBeMore();
    }
    moderation_.looked(look, nowNs);
    lookedNs_ = nowNs;
    if (nowNs - askedDroppedNs_ >= kBetweenDroppedNs) {
        core->socketDropped(dropped());
        askedDroppedNs_ = nowNs;
    }
}

// Who runs looks often: what it has not yet seen came just now.
bool Group::State::behind() {
    const int64_t nowNs = quickNowNs();
    if (moderation_.mayBeMore() || nowNs - lookedNs_ < kCaughtUpNs) return moderation_.mayBeMore();
    std::array<int, 2> sockets{own_->descriptor()};
    if (groupSocket_) sockets[1] = groupSocket_->descriptor();
    takeDatagrams(std::span(sockets).first(groupSocket_ ? 2 : 1), nowNs);
    return moderation_.mayBeMore();
}

void Group::State::pump(int64_t nowNs) {
    const int64_t next = core->tick(nowNs);
    outbox_->flush();
    armTimer(next);
    wakeWaiting();
}

// Who leads looks at the time by itself; only who sleeps already is told.
void Group::State::armTimer(int64_t atNs) {
    timerNs_ = std::min(timerNs_, atNs);
    if (leaderSleeps_ ? timerNs_ < leaderUntilNs_ : isWatched_) tellTime(timerNs_);
}

// An earlier time stays: it costs a look, and to set one costs a system call.
void Group::State::tellTime(int64_t atNs) {
    if (atNs >= toldNs_) return;
    toldNs_ = atNs;
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
    if (leaderSleeps_) tellTime(0);
}

void Group::State::wakeAll() {
    for (Waits* what : {&room, &arrived, &data}) wake(*what);
    changed.notify_all();
}

} // namespace mural::rsp
