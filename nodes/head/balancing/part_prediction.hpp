// Measured and predicted times of the nodes among which an equalizer divides a picture. Pure; not thread-safe.
//
// The prediction is the one of the equalizers' users: each part costs the same everywhere within it. A cost map knows
// more, so its nodes are expected below this time.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/range.hpp"
#include "common/geometry/viewport.hpp"

namespace mural {

class PartPrediction {
public:
    // A frame in which the node took this time. drawn: number of the assignment that it was drawn with.
    void measured(int node, uint32_t drawn, double busyNs);
    // The nodes get other parts with the assignment of this number. before, after: indexed by node.
    void moved(std::span<const int> nodes, uint32_t number, std::span<const Viewport> before,
               std::span<const Viewport> after);
    void moved(std::span<const int> nodes, uint32_t number, std::span<const Range> before,
               std::span<const Range> after);

    // Mean of the latest frames with the node's present part; nullopt: none is finished yet.
    [[nodiscard]] std::optional<double> measuredNs(int node) const;
    // For the node's present part; nullopt: it has not moved, or a time was unknown.
    [[nodiscard]] std::optional<double> predictedNs(int node) const;

private:
    struct Times {
        uint32_t drawn = 0;
        double meanNs = -1;      // negative: no frame with `drawn`
        double latestNs = -1;    // the mean of the latest part that was measured
        double predictedNs = -1; // negative: unknown
    };
    template <class Part>
    void predict(std::span<const int> nodes, uint32_t number, std::span<const Part> before,
                 std::span<const Part> after);

    std::map<int, Times> ofNodes_;
};

} // namespace mural
