// What one end of `mural netperf` measured, and how it is told: a table for people, a line of JSON for programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/rsp/group.hpp"

namespace mural::cli {

// Bytes by when they came: shows how long a stream stood still, and how soon it was as fast as before.
class Timeline {
public:
    Timeline() = default;
    explicit Timeline(int64_t stepNs) : stepNs_(stepNs) {}

    void add(uint64_t bytes, int64_t nowNs);
    [[nodiscard]] int64_t stepNs() const { return stepNs_; }
    [[nodiscard]] int64_t beganNs() const { return beganNs_; } // by the monotonic clock, which all processes share
    [[nodiscard]] const std::vector<uint64_t>& steps() const { return steps_; }

private:
    int64_t stepNs_ = 0; // 0: nothing is kept
    int64_t beganNs_ = 0;
    std::vector<uint64_t> steps_;
};

struct Measured {
    std::string role;
    uint64_t bytes = 0;
    double elapsedS = 0;
    double cpuS = 0;
    int64_t joinBeganNs = 0; // a receiver's, by the monotonic clock
    int64_t joinedNs = 0;
    size_t membersLost = 0; // a sender's: who was there at the start and is not at the end
    std::vector<double> latenciesUs; // sorted
    Timeline timeline;
    rsp::GroupReport report;
    uint64_t beganAt = 0; // a receiver's: place of its first byte in the stream
    std::string cut; // why the stream ended before its end; empty: it did not
    std::string wrong; // which byte is not the one that was sent; empty: none

    [[nodiscard]] double mbit() const { return elapsedS > 0 ? static_cast<double>(bytes) * 8e-6 / elapsedS : 0; }
    [[nodiscard]] double cpuPerGB() const { return bytes > 0 ? cpuS / (static_cast<double>(bytes) * 1e-9) : 0; }
    [[nodiscard]] double joinS() const { return static_cast<double>(joinedNs - joinBeganNs) * 1e-9; }
    [[nodiscard]] double latencyUs(double share) const;
};

void print(const Measured& m, bool asJson);

} // namespace mural::cli
