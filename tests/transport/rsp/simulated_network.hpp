// A simulated network and clock: datagrams are lost, duplicated, late, reordered, or exceed a link's rate, all decided
// by one seed. Hosts can freeze, and their sockets then overflow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <random>
#include <span>
#include <vector>

namespace mural::rsp::test {

// Faults of datagrams to one host.
struct LinkFaults {
    double loss = 0;
    double burstBegins = 0; // probability per datagram that a loss burst starts (Gilbert and Elliott)
    double burstEnds = 1;   // probability per datagram that it ends
    double twice = 0;
    double flipped = 0; // probability of a flipped bit
    double late = 0;    // share of datagrams delayed by lateNs
    int64_t lateNs = 0;
    int64_t delayNs = 50'000;
    int64_t jitterNs = 0;
    double bytesPerS = 0; // 0: no limit
    size_t queueBytes = 256 * 1024;
    bool cut = false;
};

class SimulatedNetwork {
public:
    explicit SimulatedNetwork(uint64_t seed, size_t hosts) : random_(seed), hosts_(hosts) {}

    using Handler = std::function<void(std::span<std::byte>)>;
    void onDatagram(size_t host, Handler handler) { hosts_[host].handler = std::move(handler); }
    // Called at the time set by setTimer, and after datagrams have arrived.
    void onTimer(size_t host, std::function<void()> timer) { hosts_[host].timer = std::move(timer); }
    void setTimer(size_t host, int64_t atNs);

    LinkFaults& faults(size_t host) { return hosts_[host].faults; }
    void send(size_t to, std::span<const std::byte> datagram);
    // Runs `what` at a host after a delay, in order, independent of faults; a frozen host runs it later.
    void sendReliably(size_t to, int64_t afterNs, std::function<void()> what);

    // A frozen host does nothing; its socket stores a limited number of datagrams.
    void freeze(size_t host) { hosts_[host].frozen = true; }
    void thaw(size_t host);
    // datagrams that arrived while it was frozen
    [[nodiscard]] bool socketHolds(size_t host) const { return !hosts_[host].socket.empty(); }
    void setSocketDatagrams(size_t host, size_t count) { hosts_[host].socketDatagrams = count; }
    [[nodiscard]] uint64_t overflowed(size_t host) const { return hosts_[host].overflowed; }
    [[nodiscard]] uint64_t lost() const { return lost_; }

    [[nodiscard]] int64_t nowNs() const { return nowNs_; }
    void jumpClock(int64_t ns) { nowNs_ += ns; }
    // Runs until `done` or untilNs. Returns whether it was done.
    bool run(int64_t untilNs, const std::function<bool()>& done);

    uint64_t random() { return random_(); }
    bool chance(double share) { return share > 0 && std::generate_canonical<double, 32>(random_) < share; }

private:
    struct Event {
        int64_t atNs;
        uint64_t number; // keeps the order of simultaneous events
        size_t host;
        bool timer;
        std::vector<std::byte> datagram;
        std::function<void()> what;
        bool operator<(const Event& o) const { return atNs != o.atNs ? atNs > o.atNs : number > o.number; }
    };
    struct Host {
        Handler handler;
        std::function<void()> timer;
        LinkFaults faults;
        bool inBurst = false;
        bool frozen = false;
        int64_t linkFreeNs = 0;
        int64_t timerNs = INT64_MAX;
        size_t socketDatagrams = 4096;
        uint64_t overflowed = 0;
        std::vector<std::vector<std::byte>> socket; // while frozen
        std::vector<std::function<void()>> waiting;
    };
    void deliver(Event& e);
    [[nodiscard]] bool loses(Host& h);

    std::mt19937_64 random_;
    std::vector<Host> hosts_;
    std::priority_queue<Event> events_;
    uint64_t numbers_ = 0;
    uint64_t lost_ = 0;
    int64_t nowNs_ = 1'000'000'000;
};

} // namespace mural::rsp::test
