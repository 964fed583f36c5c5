#include "tests/transport/rsp/simulated_network.hpp"

#include <algorithm>
#include <utility>

namespace mural::rsp::test {

bool SimulatedNetwork::loses(Host& h) {
    const LinkFaults& f = h.faults;
    if (f.cut) return true;
    h.inBurst = h.inBurst ? !chance(f.burstEnds) : chance(f.burstBegins);
    return h.inBurst || chance(f.loss);
}

void SimulatedNetwork::send(size_t to, std::span<const std::byte> datagram) {
    Host& h = hosts_[to];
    const LinkFaults& f = h.faults;
    if (loses(h)) {
        ++lost_;
        return;
    }
    int64_t atNs = nowNs_;
    if (f.bytesPerS > 0) {
        const double queued = static_cast<double>(std::max<int64_t>(0, h.linkFreeNs - nowNs_)) * 1e-9 * f.bytesPerS;
        if (queued > static_cast<double>(f.queueBytes)) {
            ++lost_;
            return;
        }
        h.linkFreeNs = std::max(h.linkFreeNs, nowNs_) +
                       static_cast<int64_t>(static_cast<double>(datagram.size() + 66) / f.bytesPerS * 1e9);
        atNs = h.linkFreeNs;
    }
    atNs += f.delayNs + (f.jitterNs > 0 ? static_cast<int64_t>(random_() % static_cast<uint64_t>(f.jitterNs)) : 0);
    if (chance(f.late)) atNs += f.lateNs;
    const int copies = chance(f.twice) ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
        Event e{atNs, numbers_++, to, false, {datagram.begin(), datagram.end()}, {}};
        if (chance(f.flipped)) e.datagram[random_() % e.datagram.size()] ^= static_cast<std::byte>(1 << random_() % 8);
        events_.push(std::move(e));
    }
}

void SimulatedNetwork::sendReliably(size_t to, int64_t afterNs, std::function<void()> what) {
    events_.push({nowNs_ + afterNs, numbers_++, to, false, {}, std::move(what)});
}

void SimulatedNetwork::setTimer(size_t host, int64_t atNs) {
    if (atNs == INT64_MAX) return;
    atNs = std::max(atNs, nowNs_);
    Host& h = hosts_[host];
    if (h.timerNs <= atNs && h.timerNs > nowNs_) return; // fires earlier and is then set again
    h.timerNs = atNs;
    events_.push({atNs, numbers_++, host, true, {}, {}});
}

void SimulatedNetwork::deliver(Event& e) {
    Host& h = hosts_[e.host];
    if (h.frozen) {
        if (e.timer) return;
        if (e.what)
            h.waiting.push_back(std::move(e.what));
        else if (h.socket.size() < h.socketDatagrams)
            h.socket.push_back(std::move(e.datagram));
        else
            ++h.overflowed;
        return;
    }
    if (e.timer) {
        if (h.timerNs != e.atNs) return; // replaced by an earlier one
        h.timerNs = INT64_MAX;
    } else if (e.what) {
        e.what();
    } else {
        h.handler(e.datagram);
    }
    h.timer();
}

void SimulatedNetwork::thaw(size_t host) {
    Host& h = hosts_[host];
    h.frozen = false;
    h.timerNs = INT64_MAX;
    for (auto& what : std::exchange(h.waiting, {})) { // runs before the socket is read, as another thread might
        what();
        h.timer();
    }
    for (auto& datagram : h.socket) h.handler(datagram);
    h.socket.clear();
    h.timer();
}

bool SimulatedNetwork::run(int64_t untilNs, const std::function<bool()>& done) {
    while (!done()) {
        if (events_.empty() || events_.top().atNs > untilNs) {
            nowNs_ = std::max(nowNs_, untilNs);
            return false;
        }
        Event e = events_.top();
        events_.pop();
        nowNs_ = std::max(nowNs_, e.atNs);
        deliver(e);
    }
    return true;
}

} // namespace mural::rsp::test
