// Tile assignment of one picture from frame to frame: faster nodes receive more tiles of the next frames. Pure.
//
// Input is each node's total time for its tiles. Costs of single tiles are estimated: the tiles of a node share its
// time in the previous proportions, and a tile keeps its estimate when it changes nodes. Successive cuts therefore
// converge on small expensive areas.
//
// Tiles move only if other areas promise a sufficient gain. The gain of each move is measured. After several moves
// without gain the best areas so far are restored and kept until the load changes. A constant load therefore settles
// after finitely many moves.
#pragma once

#include <optional>
#include <vector>

#include "balancer/equalizers/tile_dealing.hpp"

namespace mural::queue {

struct QueueRules {
    int frames = 2;        // frames measured before tiles move; a single one may be an outlier
    double gain = 0.06;    // promised reduction of the longest time, as a fraction
    double brought = 0.01; // measured reduction that counts as a gain, as a fraction
    int failures = 3;      // consecutive moves without a gain before the best areas are restored
    double changed = 0.15; // relative change of the longest time, without a move, that counts as a load change
};

class TileQueue {
public:
    // areas: as required by dealTiles().
    TileQueue(int columns, int rows, std::vector<TileRegion> areas, QueueRules rules = {});

    [[nodiscard]] const std::vector<TileRegion>& areas() const { return areas_; }
    [[nodiscard]] int columns() const { return costs_.columns(); }
    [[nodiscard]] int rows() const { return costs_.rows(); }

    // Reports the time of each node for a frame drawn with areas(), in any unit. Returns true if areas() has changed.
    bool drawn(const std::vector<double>& times);

private:
    bool rebalance(double longest);
    bool takeAreas(std::vector<TileRegion> areas);

    const QueueRules rules_;
    TileCosts costs_;
    std::vector<TileRegion> areas_;
    std::vector<double> times_; // weighted mean since the last move; recent frames count most
    int frames_ = 0;            // number of frames in the mean
    bool moved_ = false;        // the gain of the last move is not measured yet
    int failures_ = 0;
    std::vector<TileRegion> best_; // best areas for the current load
    double bestLongest_ = 0;       // their longest time; 0: none yet
    bool settled_ = false;         // areas are kept until the load changes
};

// Returns the number of tiles that belong to different nodes in `a` and `b`.
int tilesMoved(const std::vector<TileRegion>& a, const std::vector<TileRegion>& b);

} // namespace mural::queue
