// The leader of a swap barrier. One thread accepts members, and one thread per member receives its messages.
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "nodes/swap_barrier/barrier_message.hpp"
#include "nodes/swap_barrier/barrier_rounds.hpp"
#include "nodes/swap_barrier/swap_barrier.hpp"
#include "transport/connection.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

class BarrierLeader final : public SwapBarrier {
public:
    BarrierLeader(int members, const ChannelSecret& secret, int64_t patienceMs = kPatienceMs);
    ~BarrierLeader() override;

    // Listens on a free port, port(). loopbackOnly: all members run on this machine.
    Result<void> listen(bool loopbackOnly);
    [[nodiscard]] uint16_t port() const { return port_; }

    int64_t await(const SwapKey& key) override;
    void shown(const SwapKey& key, int64_t atNs) override;
    [[nodiscard]] std::optional<SwapBarrierNumbers> numbers() const override;

private:
    struct Member {
        std::unique_ptr<Connection> connection;
        std::thread thread;
        int64_t readySentNs = 0, arrivedNs = 0, errorNs = INT64_MAX; // of its last message
    };
    void letIn();
    void follow(int rank, Connection& connection);
    void take(int rank, const BarrierReady& ready, int64_t arrivedNs);
    void apply(const BarrierRounds::Step& step); // call with the lock held
    void reportSkew();
    // Selects members for a measurement. Waiting: those that a round waits for. All: also those that have left, as all
    // have when a run ends.
    enum class Members : uint8_t { Waiting, All };
    [[nodiscard]] int64_t worstClockNs(Members members) const;

    const int count_;
    const ChannelSecret secret_;
    const int64_t patienceMs_;
    std::unique_ptr<Listener> listener_;
    uint16_t port_ = 0;
    std::thread thread_;
    std::atomic<bool> stop_{false};

    mutable std::mutex mutex_; // guards the members below
    std::condition_variable went_;
    BarrierRounds rounds_;
    SkewMeter skew_;
    std::map<int, Member> members_; // by rank; entries keep their addresses
    bool waiting_ = false;
    int64_t showNs_ = 0;
    int64_t reportNs_ = 0; // time of the next diagnostic
};

} // namespace mural
