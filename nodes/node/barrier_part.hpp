// A node's part in the swap barrier that the head has put it into: as the leader, or by a connection to it.
#pragma once

#include <memory>
#include <string>

#include "nodes/session/session_config.hpp"
#include "nodes/swap_barrier/swap_barrier.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

class BarrierPart {
public:
    BarrierPart(const NodeSetup& setup, SwapBarrier::Log log) : rank_(setup.swapRank), members_(setup.swapMembers), here_(setup.swapHere), secretHex_(setup.exchangeSecret), log_(std::move(log)) {}

    // The leader: lets the others in. The port; 0: it is not the leader.
    Result<uint16_t> open();
    // The others: to the leader. Errors are told: the node shows its windows by itself then.
    void follow(const std::string& host, uint16_t port);

    [[nodiscard]] SwapBarrier* barrier() const { return barrier_.get(); }

private:
    const int rank_, members_;
    const bool here_;
    const std::string secretHex_;
    const SwapBarrier::Log log_;
    std::unique_ptr<SwapBarrier> barrier_;
};

} // namespace mural
