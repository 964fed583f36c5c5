// When a node announces itself: every second, and soon when it is asked, yet never more than five times a second, however
// often it is asked. Without sockets and clock.
#pragma once

#include <functional>
#include <random>

#include "transport/discovery/announcement.hpp"

namespace mural {

class Announcer {
public:
    static constexpr int64_t kEveryNs = 1'000'000'000;
    static constexpr int64_t kLeastBetweenNs = 200'000'000;
    static constexpr int64_t kMostAnswerNs = 50'000'000; // so that not all nodes answer at once

    Announcer(Announcement self, uint64_t seed) : self_(std::move(self)), random_(seed) {}

    void heard(const Announcement& a, int64_t nowNs);
    // Says what is due; returns when to come again.
    int64_t tick(int64_t nowNs, const std::function<void(std::span<const std::byte>)>& say);
    // The last word.
    [[nodiscard]] std::vector<std::byte> farewell() const;

private:
    Announcement self_;
    std::mt19937_64 random_;
    int64_t saidNs_ = INT64_MIN / 2;
    int64_t dueNs_ = INT64_MIN;
};

} // namespace mural
