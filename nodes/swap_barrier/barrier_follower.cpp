#include "nodes/swap_barrier/barrier_follower.hpp"

#include <algorithm>

#include "common/log/log.hpp"
#include "nodes/swap_barrier/barrier_names.hpp"
#include "transport/secure/secure_connection.hpp"

namespace mural {

namespace {

constexpr int64_t kSendMs = 2000;
constexpr int64_t kMaxSleepNs = 20 * kNsPerMs;              // upper bound, whatever time the leader sends
constexpr int64_t kAnswerMs = 4 * SwapBarrier::kPatienceMs; // longer than the leader waits for any member

} // namespace

Result<std::unique_ptr<SwapBarrier>> BarrierFollower::connect(int rank, const ChannelSecret& secret,
                                                              const std::string& host, uint16_t port,
                                                              Deadline deadline) {
    auto connection = connectTcp(host, port, deadline);
    if (!connection) return connection.error();
    auto secure = SecureConnection::connecting(std::move(*connection), barrierNameOf(rank), secret, deadline);
    if (!secure) return secure.error();
    log::debug(log::Topic::Barrier, "connected to the leader at ", host, ":", port, " as member ", rank + 1);
    return std::unique_ptr<SwapBarrier>(std::make_unique<BarrierFollower>(std::move(*secure)));
}

Result<BarrierGo> BarrierFollower::request(const SwapKey& key) {
    BarrierReady ready{key, shownKey_, shownNs_, 0, clock_.errorNs()};
    shownNs_ = 0;
    ready.sentNs = monotonicNowNs();
    if (auto sent = leader_->write(encode(ready), Deadline::inMs(kSendMs)); !sent) return sent.error();
    leader_->flush();
    std::array<std::byte, kGoBytes> bytes;
    if (auto came = leader_->read(bytes, Deadline::inMs(kAnswerMs)); !came) return came.error();
    const int64_t nowNs = monotonicNowNs();
    const BarrierGo go = decodeGo(bytes);
    if (go.key != key) return Error{"it replied for another swap"};
    clock_.add({ready.sentNs, go.arrivedNs, go.leftNs, nowNs});
    return go;
}

int64_t BarrierFollower::await(const SwapKey& key) {
    if (!leader_) return 0;
    auto go = request(key);
    if (go && go->showNs == 0) return 0; // released alone: there is no common time to wait for
    if (go) return std::min(go->showNs - clock_.offsetNs(), monotonicNowNs() + kMaxSleepNs);
    log::warning(log::Topic::Barrier, "the swap barrier is disconnected: its leader is lost: ", go.error().message,
                 "; windows of this node show frames without the barrier");
    leader_.reset();
    return 0;
}

void BarrierFollower::shown(const SwapKey& key, int64_t atNs) {
    shownKey_ = key;
    shownNs_ = atNs + clock_.offsetNs();
}

} // namespace mural
