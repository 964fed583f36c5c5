// A member of a swap barrier that is connected to the leader.
#pragma once

#include <memory>
#include <string>

#include "nodes/swap_barrier/barrier_message.hpp"
#include "nodes/swap_barrier/clock_offset.hpp"
#include "nodes/swap_barrier/swap_barrier.hpp"
#include "transport/connection.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

class BarrierFollower final : public SwapBarrier {
public:
    // rank: from 1.
    static Result<std::unique_ptr<SwapBarrier>> connect(int rank, const ChannelSecret& secret, const std::string& host,
                                                        uint16_t port, Deadline deadline);
    explicit BarrierFollower(std::unique_ptr<Connection> leader) : leader_(std::move(leader)) {}

    int64_t await(const SwapKey& key) override;
    void shown(const SwapKey& key, int64_t atNs) override;

private:
    Result<BarrierGo> request(const SwapKey& key);

    std::unique_ptr<Connection> leader_; // null: connection lost
    ClockOffset clock_;
    SwapKey shownKey_;
    int64_t shownNs_ = 0; // by the leader's clock; 0: already reported, or nothing was shown
};

} // namespace mural
