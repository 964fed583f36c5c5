// The parts of compositing_bench. Each prints its tables and returns errors of results; times are never judged.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/picture/plane_file.hpp"

namespace mural::bench {

struct BenchOptions {
    bool quick = false;
    int turns = 9;           // repetitions per measurement
    std::string icetLibrary; // icet_kernels.c built against IceT; empty: omitted
};

using Faults = std::vector<std::string>;

[[nodiscard]] Faults benchCodecs(const std::vector<NamedPlane>& planes, const BenchOptions& options);
[[nodiscard]] Faults benchKernels(const std::vector<NamedPlane>& planes, const BenchOptions& options);
[[nodiscard]] Faults benchSelector(const std::vector<NamedPlane>& planes, const BenchOptions& options);
[[nodiscard]] Faults benchRanks(const std::vector<NamedPlane>& planes, const BenchOptions& options);

} // namespace mural::bench
