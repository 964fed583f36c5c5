#include "nodes/head/frames/credit_pacer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/clock.hpp"

namespace mural {
namespace {

constexpr int64_t kMaxIntervalNs = kNsPerS; // a slower pace would look like a stopped program

} // namespace

void PacedCredit::setInterval(int64_t ns, int64_t nowNs) {
    intervalNs_ = std::clamp<int64_t>(ns, 0, kMaxIntervalNs);
    nextNs_ = std::min(nextNs_, nowNs + intervalNs_);
}

// A frame that was late does not make the next one early: the pace limits every interval.
uint32_t PacedCredit::at(int64_t nowNs) {
    if (intervalNs_ == 0) {
        credited_ = finished_;
    } else if (credited_ < finished_ && nowNs >= nextNs_) {
        ++credited_;
        nextNs_ = nowNs + intervalNs_;
    }
    return credited_;
}

std::optional<int64_t> PacedCredit::nextNs() const {
    if (credited_ >= finished_) return std::nullopt;
    return nextNs_;
}

CreditPacer::~CreditPacer() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

void CreditPacer::add(uint32_t client, uint32_t finished, uint32_t shown) {
    const std::lock_guard lock(mutex_);
    Client& c = clients_[client];
    c.credit.add(finished);
    const bool isShown = std::exchange(c.shown, shown) != shown;
    const uint32_t before = c.sent;
    send(client, c, monotonicNowNs());
    if (isShown && c.sent == before) send_(client, c.sent, c.shown);
    if (thread_.joinable()) changed_.notify_all();
}

void CreditPacer::setPace(uint32_t client, double framesPerSecond) {
    const int64_t nowNs = monotonicNowNs();
    const std::lock_guard lock(mutex_);
    const double ns = framesPerSecond > 0 ? static_cast<double>(kNsPerS) / framesPerSecond : 0;
    Client& c = clients_[client];
    c.credit.setInterval(std::llround(std::min(ns, static_cast<double>(kMaxIntervalNs))), nowNs);
    send(client, c, nowNs);
    if (ns > 0 && !thread_.joinable()) thread_ = std::thread([this] { run(); });
    changed_.notify_all();
}

void CreditPacer::endPaces() {
    const int64_t nowNs = monotonicNowNs();
    const std::lock_guard lock(mutex_);
    for (auto& [id, client] : clients_) {
        client.credit.setInterval(0, nowNs);
        send(id, client, nowNs);
    }
}

void CreditPacer::clientGone(uint32_t client) {
    const std::lock_guard lock(mutex_);
    clients_.erase(client);
}

// Requires mutex_.
void CreditPacer::send(uint32_t id, Client& client, int64_t nowNs) {
    const uint32_t finished = client.credit.at(nowNs);
    if (finished == client.sent) return;
    client.sent = finished;
    send_(id, client.sent, client.shown);
}

void CreditPacer::run() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
        const int64_t nowNs = monotonicNowNs();
        std::optional<int64_t> next;
        for (auto& [id, client] : clients_) {
            send(id, client, nowNs);
            if (const auto at = client.credit.nextNs()) next = std::min(next.value_or(*at), *at);
        }
        if (!next)
            changed_.wait(lock);
        else
            changed_.wait_for(lock, std::chrono::nanoseconds(std::max<int64_t>(*next - nowNs, 0)));
    }
}

} // namespace mural
