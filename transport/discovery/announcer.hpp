// Schedule of a node's announcements: every second, and soon after a search, but at most five per second. Has no
// sockets or clock.
#pragma once

#include <functional>
#include <random>

#include "transport/discovery/announcement.hpp"

namespace mural {

class Announcer {
public:
    static constexpr int64_t kEveryNs = 1'000'000'000;
    static constexpr int64_t kMinBetweenNs = 200'000'000;
    // random delay of an answer, so nodes do not answer simultaneously
    static constexpr int64_t kMaxAnswerNs = 50'000'000;

    Announcer(Announcement self, uint64_t seed) : self_(std::move(self)), random_(seed) {}

    void onAnnouncement(const Announcement& a, int64_t nowNs);
    // Sends due announcements; returns the time of the next call.
    int64_t tick(int64_t nowNs, const std::function<void(std::span<const std::byte>)>& broadcast);
    // Returns the final announcement.
    [[nodiscard]] std::vector<std::byte> farewell() const;

private:
    Announcement self_;
    std::mt19937_64 random_;
    int64_t sentNs_ = INT64_MIN / 2;
    int64_t dueNs_ = INT64_MIN;
};

} // namespace mural
