// The tiles of one picture from frame to frame: who is free earlier takes more of the next ones. Pure.
//
// Measured are the nodes' times, each of all its tiles. What a single tile costs is learned from that: the tiles of a node
// share its time as they did before, and those that change hands take along what they were thought to cost. So an area of
// few costly tiles among many is found by the cuts that come nearer to it.
//
// Tiles stay where they are unless other areas promise enough. What a move has brought is measured: where several in a row
// bring nothing, the best areas so far are taken and kept until the load is another one. So a load that stays the same is
// settled after finitely many moves.
#pragma once

#include <optional>
#include <vector>

#include "balancer/queue/tile_dealing.hpp"

namespace mural::queue {

struct QueueRules {
    int frames = 2;        // measured before tiles move: one alone may be an odd one
    double gain = 0.06;    // part of the longest time that new areas must promise to save…
    double brought = 0.01; // …and to have saved, measured
    int failures = 3;      // moves in a row that have not
    double changed = 0.15; // part by which the longest time becomes another while nothing moves: the load has changed
};

class TileQueue {
public:
    // areas: as dealTiles() takes them.
    TileQueue(int columns, int rows, std::vector<TileRegion> areas, QueueRules rules = {});

    [[nodiscard]] const std::vector<TileRegion>& areas() const { return areas_; }
    [[nodiscard]] int columns() const { return costs_.columns(); }
    [[nodiscard]] int rows() const { return costs_.rows(); }

    // What a frame that was drawn with areas() took each node; any unit. True: areas() are others now.
    bool drawn(const std::vector<double>& times);

private:
    bool look(double longest);
    bool takeAreas(std::vector<TileRegion> areas);

    const QueueRules rules_;
    TileCosts costs_;
    std::vector<TileRegion> areas_;
    std::vector<double> times_; // since the last move, the latest count most
    int frames_ = 0;            // of them
    bool moved_ = false;        // what the last move brought is not known yet
    int failures_ = 0;
    std::vector<TileRegion> best_; // of this load…
    double bestLongest_ = 0;       // …and the time that they took; 0: none yet
    bool kept_ = false;            // they are, until the load changes
};

// Tiles that are another node's in `b` than in `a`.
int tilesMoved(const std::vector<TileRegion>& a, const std::vector<TileRegion>& b);

} // namespace mural::queue
