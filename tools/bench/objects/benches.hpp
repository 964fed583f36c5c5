// The parts of objects_bench. Each prints a table and returns the number of wrong results; times are never judged.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <mural/archive.hpp>

namespace mural::bench {

struct ObjectBenchOptions {
    bool quick = false; // few turns: are the results right?
    int turns = 200;
};

// 37 fields, 1.2 KB: a state of usual size.
struct BenchState {
    std::array<float, 256> samples{};
    std::array<double, 16> pose{};
    std::array<double, 19> numbers{};
    std::array<int32_t, 16> counts{};
    template <class Visit> void fields(Visit& visit) {
        visit(samples, pose);
        for (double& number : numbers) visit(number);
        for (int32_t& count : counts) visit(count);
    }
    friend bool operator==(const BenchState&, const BenchState&) = default;
};

// Encoding and decoding beside memcpy.
int benchEncoding(const ObjectBenchOptions& options);
// CPU time and bytes of a commit with one changed field.
int benchCommits(const ObjectBenchOptions& options);
// A blob of 16 MiB to 1, 4 and 8 processes of this machine.
int benchBlobs(const ObjectBenchOptions& options);
// A commit of 64 bytes to 1, 4 and 8 processes of this machine, beside plain TCP and ZeroMQ.
int benchFanOut(const ObjectBenchOptions& options);

// Median, and the quartiles as spread.
struct Summary {
    double median = 0, low = 0, high = 0;
};
inline Summary summaryOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto at = [&](double part) {
        return values[static_cast<size_t>(part * static_cast<double>(values.size() - 1))];
    };
    return {at(.5), at(.25), at(.75)};
}

} // namespace mural::bench
