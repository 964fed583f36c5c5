// A limit of events per second, with a burst of one second. Pure; not thread-safe.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mural::page {

class RateLimit {
public:
    explicit RateLimit(int64_t perSecond) : perSecond_(perSecond), tokens_(static_cast<double>(perSecond)) {}

    // Returns whether an event at this time is within the limit, and counts it if so.
    [[nodiscard]] bool take(int64_t nowNs) {
        constexpr double kPerSecond = 1e9;
        const auto most = static_cast<double>(perSecond_);
        const double passed = static_cast<double>(nowNs - lastNs_) / kPerSecond;
        if (lastNs_ != 0 && passed > 0) tokens_ = std::min(most, tokens_ + passed * most);
        lastNs_ = nowNs;
        if (tokens_ < 1) return false;
        tokens_ -= 1;
        return true;
    }

private:
    int64_t perSecond_;
    double tokens_;
    int64_t lastNs_ = 0; // 0: no event yet
};

} // namespace mural::page
