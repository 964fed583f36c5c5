// A node's end of its swap barrier: as the leader, or connected to the leader.
#pragma once

#include <memory>
#include <string>

#include "nodes/session/session_config.hpp"
#include "nodes/swap_barrier/swap_barrier.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

class BarrierPart {
public:
    explicit BarrierPart(const NodeSetup& setup)
        : rank_(setup.swapRank), members_(setup.swapMembers), here_(setup.swapHere), secretHex_(setup.exchangeSecret) {}

    // Leader only: listens for the other members. Returns the port; 0: not the leader.
    Result<uint16_t> open();
    // Connects to the leader. On error, reports it to the user and shows this node's windows without the barrier.
    void follow(const std::string& host, uint16_t port);

    [[nodiscard]] SwapBarrier* barrier() const { return barrier_.get(); }

private:
    const int rank_, members_;
    const bool here_;
    const std::string secretHex_;
    std::unique_ptr<SwapBarrier> barrier_;
};

} // namespace mural
