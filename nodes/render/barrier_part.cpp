#include "nodes/render/barrier_part.hpp"

#include "common/log/log.hpp"
#include "nodes/session/session_secret.hpp"
#include "nodes/swap_barrier/barrier_follower.hpp"
#include "nodes/swap_barrier/barrier_leader.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

namespace {

constexpr int64_t kBarrierConnectMs = 10'000;

} // namespace

Result<uint16_t> BarrierPart::open() {
    if (rank_ != 0) return uint16_t{0};
    const auto secret = sessionSecretFromHex(secretHex_);
    if (!secret) return Error{"the head sent an invalid secret for the swap barrier: " + secret.error().message};
    auto leader = std::make_unique<BarrierLeader>(members_, secret.value());
    if (auto listening = leader->listen(here_); !listening)
        return Error{"cannot listen for the swap barrier: " + listening.error().message};
    const uint16_t port = leader->port();
    barrier_ = std::move(leader);
    return port;
}

void BarrierPart::follow(const std::string& host, uint16_t port) {
    if (rank_ == 0 || barrier_) return;
    const auto secret = sessionSecretFromHex(secretHex_);
    if (!secret)
        return log::warning(log::Topic::Barrier,
                            "the head sent an invalid secret for the swap barrier: ", secret.error().message,
                            "; windows of this node show frames without the barrier");
    auto follower = BarrierFollower::connect(rank_, secret.value(), host, port, Deadline::inMs(kBarrierConnectMs));
    if (follower)
        barrier_ = std::move(*follower);
    else
        log::warning(log::Topic::Barrier, "cannot connect to the leader of the swap barrier at ",
                     endpointText(host, port), ": ", follower.error().message,
                     "; windows of this node show frames without the barrier");
}

} // namespace mural
