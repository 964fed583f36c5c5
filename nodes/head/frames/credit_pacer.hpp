// Spaces the credit of a program evenly (framerate_equalizer). Nodes that draw frames in turn finish them in bursts.
// Without pacing the program begins its next frames in bursts as well, and the wall shows them at uneven times.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

namespace mural {

// The credit of one program. Pure; times are on the monotonic clock.
class PacedCredit {
public:
    // finished: frames that all nodes have finished.
    void add(uint32_t finished) { finished_ = finished; }
    // Sets the shortest time between two frames of credit; 0: none.
    void setInterval(int64_t ns, int64_t nowNs);

    // Returns the frames of credit at this time.
    uint32_t at(int64_t nowNs);
    // The time at which the credit grows next; empty: not without add().
    [[nodiscard]] std::optional<int64_t> nextNs() const;

private:
    int64_t intervalNs_ = 0;
    int64_t nextNs_ = 0; // earliest time of the next frame
    uint32_t finished_ = 0, credited_ = 0;
};

// Thread-safe. A thread of its own runs after the first interval.
class CreditPacer {
public:
    // Called with the pacer's lock held, hence in order; must not block.
    using Send = std::function<void(uint32_t client, uint32_t finished, uint32_t shown)>;

    explicit CreditPacer(Send send) : send_(std::move(send)) {}
    ~CreditPacer();
    CreditPacer(const CreditPacer&) = delete;
    CreditPacer& operator=(const CreditPacer&) = delete;

    // Credits frames at once, or later if they come faster than the pace of the client. `shown` is never delayed.
    void add(uint32_t client, uint32_t finished, uint32_t shown);
    // 0: no pace, for clients without a call, too.
    void setPace(uint32_t client, double framesPerSecond);
    void endPaces(); // of all clients
    void clientGone(uint32_t client);

private:
    struct Client {
        PacedCredit credit;
        uint32_t sent = 0, shown = 0;
    };

    void send(uint32_t id, Client& client, int64_t nowNs);
    void run();

    const Send send_;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::map<uint32_t, Client> clients_;
    bool ends_ = false;
    std::thread thread_;
};

} // namespace mural
