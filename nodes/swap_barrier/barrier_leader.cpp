#include "nodes/swap_barrier/barrier_leader.hpp"

#include <algorithm>
#include <chrono>

#include "common/log/log.hpp"
#include "nodes/swap_barrier/barrier_names.hpp"
#include "transport/tcp/free_port.hpp"
#include "transport/secure/secure_connection.hpp"

namespace mural {

namespace {

constexpr int64_t kSliceMs = 100; // poll interval for late members and for the end
constexpr int64_t kProofPatienceMs = 5000;
constexpr int64_t kGoSendMs = 1000;
constexpr int64_t kRestMs = 1000; // for the rest of a message
constexpr int64_t kWakeNs = 50'000;
constexpr int64_t kReportNs = kNsPerS; // interval of diagnostics
constexpr int64_t kMaxLeadNs =
    4 * kNsPerMs; // longest time from release to show; members with a higher latency show later

std::string memberText(int rank) { return "member " + std::to_string(rank + 1) + " of the swap barrier"; }

} // namespace

BarrierLeader::BarrierLeader(int members, const ChannelSecret& secret, int64_t patienceMs)
    : count_(members), secret_(secret), patienceMs_(patienceMs), rounds_(members, patienceMs * kNsPerMs) {}

BarrierLeader::~BarrierLeader() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    for (auto& [rank, member] : members_) {
        member.connection->close();
        member.thread.join();
    }
}

Result<void> BarrierLeader::listen(bool loopbackOnly) {
    auto free = listenOnFreePort(loopbackOnly);
    if (!free) return free.error();
    port_ = free->port;
    listener_ = std::move(free->listener);
    thread_ = std::thread([this] { letIn(); });
    return {};
}

void BarrierLeader::letIn() {
    while (!stop_) {
        auto connection = listener_->accept(Deadline::inMs(kSliceMs));
        if (!connection) continue;
        const auto find = [&](const std::string& name) {
            const int rank = barrierRankOf(name);
            return rank > 0 && rank < count_ ? std::optional(secret_) : std::nullopt;
        };
        auto shown = SecureConnection::accepting(std::move(*connection), find, Deadline::inMs(kProofPatienceMs),
                                                 [this] { return stop_.load(); });
        if (!shown) continue;
        const int rank = barrierRankOf((*shown)->name());
        const std::lock_guard lock(mutex_);
        if (members_.contains(rank)) continue; // the first connection wins
        Member& member = members_[rank];
        log::debug(log::Topic::Barrier, memberText(rank), " has connected");
        member.connection = std::move(*shown);
        member.thread = std::thread([this, rank, &c = *member.connection] { follow(rank, c); });
    }
}

void BarrierLeader::follow(int rank, Connection& connection) {
    std::array<std::byte, kReadyBytes> bytes;
    while (!stop_) {
        auto first = connection.read(std::span(bytes).first(1), Deadline::inMs(kSliceMs));
        if (!first && connection.timedOut()) {
            const std::lock_guard lock(mutex_);
            apply(rounds_.tick(monotonicNowNs()));
            continue;
        }
        const int64_t nowNs = monotonicNowNs();
        if (!first || !connection.read(std::span(bytes).subspan(1), Deadline::inMs(kRestMs))) break;
        take(rank, decodeReady(bytes), nowNs);
    }
    if (stop_) return;
    log::warning(log::Topic::Barrier, memberText(rank), " is lost: the others swap without it");
    const std::lock_guard lock(mutex_);
    apply(rounds_.gone(rank, monotonicNowNs()));
}

void BarrierLeader::take(int rank, const BarrierReady& ready, int64_t arrivedNs) {
    const std::lock_guard lock(mutex_);
    Member& member = members_.at(rank);
    member.readySentNs = ready.sentNs;
    member.arrivedNs = arrivedNs;
    member.errorNs = ready.errorNs;
    if (ready.shownNs != 0) skew_.shown(ready.shownKey, ready.shownNs);
    apply(rounds_.arrive(rank, ready.key, arrivedNs));
}

int64_t BarrierLeader::worstClockNs(Members members) const {
    int64_t worst = 0;
    for (const auto& [rank, member] : members_)
        if ((members == Members::All || !rounds_.isGone(rank)) && member.errorNs != INT64_MAX)
            worst = std::max(worst, member.errorNs);
    return worst;
}

void BarrierLeader::apply(const BarrierRounds::Step& step) {
    for (const int rank : step.late) {
        const std::string member = rank == 0 ? "the leader of the swap barrier" : memberText(rank);
        log::warning(log::Topic::Barrier, member, " did not reply for ", patienceMs_,
                     " ms: the others swap without it until it replies");
    }
    for (const BarrierRounds::Release& release : step.releases) {
        skew_.released(release.key, release.members.size());
        // The estimated time at which all members have received the release.
        const int64_t showNs = release.members.size() < 2
                                   ? 0
                                   : monotonicNowNs() + std::min(worstClockNs(Members::Waiting) + kWakeNs, kMaxLeadNs);
        for (const int rank : release.members) {
            if (rank == 0) {
                waiting_ = false;
                showNs_ = showNs;
                went_.notify_all();
                continue;
            }
            Member& member = members_.at(rank);
            const BarrierGo go{release.key, member.readySentNs, member.arrivedNs, monotonicNowNs(), showNs};
            if (member.connection->write(encode(go), Deadline::inMs(kGoSendMs)))
                member.connection->flush();
            else
                member.connection->close(); // its thread reports the loss
        }
    }
}

int64_t BarrierLeader::await(const SwapKey& key) {
    std::unique_lock lock(mutex_);
    waiting_ = true;
    apply(rounds_.arrive(0, key, monotonicNowNs()));
    while (waiting_) {
        if (went_.wait_for(lock, std::chrono::milliseconds(kSliceMs)) == std::cv_status::timeout)
            apply(rounds_.tick(monotonicNowNs()));
    }
    return showNs_;
}

void BarrierLeader::shown(const SwapKey& key, int64_t atNs) {
    const std::lock_guard lock(mutex_);
    skew_.shown(key, atNs);
    if (log::enabled(log::Topic::Barrier, log::Level::Debug)) reportSkew();
}

// Requires mutex_.
void BarrierLeader::reportSkew() {
    const int64_t nowNs = monotonicNowNs();
    if (nowNs < reportNs_) return;
    reportNs_ = nowNs + kReportNs;
    const SkewNumbers skew = skew_.numbers();
    log::debug(log::Topic::Barrier, skew.swaps, " swaps, skew ", skew.medianNs / 1000, " us (median), ",
               skew.p99Ns / 1000, " us (99 %), ", skew.maxNs / 1000, " us at most; clocks known to ",
               worstClockNs(Members::Waiting) / 1000, " us");
}

std::optional<SwapBarrierNumbers> BarrierLeader::numbers() const {
    const std::lock_guard lock(mutex_);
    return SwapBarrierNumbers{skew_.numbers(), worstClockNs(Members::All)};
}

} // namespace mural
