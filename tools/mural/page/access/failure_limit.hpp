// Limits failed logins per address: ten per minute, then none is tried. Pure; not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace mural::page {

class FailureLimit {
public:
    static constexpr size_t kMostFailures = 10;
    static constexpr int64_t kWindowNs = 60'000'000'000;

    // Returns whether a login of this address may be tried.
    [[nodiscard]] bool permits(const std::string& address, int64_t nowNs);
    void failed(const std::string& address, int64_t nowNs);

private:
    static constexpr size_t kMostAddresses = 4096;

    void forgetOld(int64_t nowNs);

    std::map<std::string, std::deque<int64_t>> failures_; // times, oldest first
};

} // namespace mural::page
