// Results of one end of `mural netperf`, printed as a table or as a line of JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/rsp/group.hpp"

namespace mural::cli {

// Received bytes over time: shows the length of a stall and the recovery.
class Timeline {
public:
    Timeline() = default;
    explicit Timeline(int64_t stepNs) : stepNs_(stepNs) {}

    void add(uint64_t bytes, int64_t nowNs);
    [[nodiscard]] int64_t stepNs() const { return stepNs_; }
    [[nodiscard]] int64_t beganNs() const { return beganNs_; } // monotonic clock, which all processes share
    [[nodiscard]] const std::vector<uint64_t>& steps() const { return steps_; }

private:
    int64_t stepNs_ = 0; // 0: nothing is recorded
    int64_t beganNs_ = 0;
    std::vector<uint64_t> steps_;
};

struct Measured {
    std::string role;
    uint64_t bytes = 0;
    double elapsedS = 0;
    double cpuS = 0;
    int64_t joinBeganNs = 0; // receiver: on the monotonic clock
    int64_t joinedNs = 0;
    size_t membersLost = 0;          // sender: members at the start that are missing at the end
    std::vector<double> latenciesUs; // sorted
    Timeline timeline;
    rsp::GroupReport report;
    uint64_t beganAt = 0; // receiver: position of its first byte in the stream
    std::string cut;      // reason of a premature end; empty: none
    std::string wrong;    // first wrong byte; empty: none

    [[nodiscard]] double mbit() const { return elapsedS > 0 ? static_cast<double>(bytes) * 8e-6 / elapsedS : 0; }
    [[nodiscard]] double cpuPerGB() const { return bytes > 0 ? cpuS / (static_cast<double>(bytes) * 1e-9) : 0; }
    [[nodiscard]] double joinS() const { return static_cast<double>(joinedNs - joinBeganNs) * 1e-9; }
    [[nodiscard]] double latencyUs(double share) const;
};

void print(const Measured& m, bool asJson);

} // namespace mural::cli
