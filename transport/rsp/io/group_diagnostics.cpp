#include "transport/rsp/io/group_diagnostics.hpp"

#include <cmath>
#include <utility>

#include "common/log/log.hpp"

namespace mural::rsp {

namespace {

constexpr int64_t kIntervalNs = 250'000'000;
constexpr double kRateShare = 0.02; // smaller changes of the rate are not reported

} // namespace

void GroupDiagnostics::look(GroupCore& core, int64_t nowNs) {
    if (!log::enabled(log::Topic::Rsp, log::Level::Debug) || nowNs < nextNs_) return;
    nextNs_ = nowNs + kIntervalNs;
    if (const Sender* sender = core.sender()) compareSender(*sender);
    for (const auto& [id, info] : core.members())
        if (const Receiver* receiver = core.receiver(id)) compareReceiver(id, *receiver);
}

void GroupDiagnostics::compareSender(const Sender& sender) {
    const SenderCounters before = std::exchange(sent_, sender.counters());
    const uint64_t resent = sent_.resent - before.resent, parity = sent_.rows - before.rows,
                   ahead = sent_.rowsAhead - before.rowsAhead, refused = sent_.refused - before.refused;
    if (resent + parity + refused > 0)
        log::debug(log::Topic::Rsp, "sent ", sent_.datagrams - before.datagrams, " datagrams and, for repair, ", resent,
                   " retransmissions and ", parity, " parity symbols, ", ahead,
                   " of them in advance; refused feedback: ", refused);
    else if (sent_.datagrams != before.datagrams)
        log::trace(log::Topic::Rsp, "sent ", sent_.datagrams - before.datagrams, " datagrams without repair");
    for (const auto& [id, member] : sender.members()) compareMember(id, member);
    if (!sender.rate().limited() || sent_.datagrams == 0) return;
    const double rate = sender.rate().bytesPerS();
    if (std::abs(rate - bytesPerS_) <= kRateShare * rate) return;
    log::debug(log::Topic::Rsp, "rate ", bytesPerS_ / 1e6, " -> ", rate / 1e6, " MB/s; loss without congestion ",
               100 * sender.rate().lossFloor(), " %");
    bytesPerS_ = rate;
}

void GroupDiagnostics::compareMember(MemberId id, const MemberState& member) {
    const Losses before = std::exchange(reported_[id], {member.lost, member.dropped});
    if (member.lost == before.lost && member.dropped == before.dropped) return;
    log::debug(log::Topic::Rsp, "member ", id, " reports ", member.lost - before.lost, " lost datagrams, ",
               member.dropped - before.dropped, " dropped by its socket; round trip ", member.roundTripNs / 1000,
               " us");
}

void GroupDiagnostics::compareReceiver(MemberId from, const Receiver& receiver) {
    const uint32_t lost = receiver.lost() - std::exchange(missed_[from], receiver.lost());
    const uint64_t recovered = receiver.counters().recovered;
    const uint64_t restored = recovered - std::exchange(reconstructed_[from], recovered);
    if (lost == 0 && restored == 0) return;
    log::debug(log::Topic::Rsp, "stream of member ", from, ": ", lost, " datagrams lost, ", restored,
               " restored from parity");
}

} // namespace mural::rsp
