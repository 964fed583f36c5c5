#include "tools/mural/page/access/failure_limit.hpp"

#include <iterator>

namespace mural::page {

void FailureLimit::forgetOld(int64_t nowNs) {
    for (auto at = failures_.begin(); at != failures_.end();) {
        auto& times = at->second;
        while (!times.empty() && times.front() <= nowNs - kWindowNs) times.pop_front();
        at = times.empty() ? failures_.erase(at) : std::next(at);
    }
}

bool FailureLimit::permits(const std::string& address, int64_t nowNs) {
    const auto found = failures_.find(address);
    if (found == failures_.end()) return true;
    forgetOld(nowNs);
    const auto left = failures_.find(address);
    return left == failures_.end() || left->second.size() < kMostFailures;
}

void FailureLimit::failed(const std::string& address, int64_t nowNs) {
    forgetOld(nowNs);
    // Many addresses at once are one attacker. The table stays bounded, and the new address counts for all others.
    const bool isFull = failures_.size() >= kMostAddresses && !failures_.contains(address);
    auto& times = failures_[isFull ? failures_.begin()->first : address];
    times.push_back(nowNs);
    if (times.size() > kMostFailures) times.pop_front();
}

} // namespace mural::page
