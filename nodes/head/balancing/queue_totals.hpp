// The totals of a queue, for reports.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mural {

struct QueueTotals {
    std::string name;
    bool chunks = false;                    // chunks of draws, in one row of columns; otherwise tiles
    int columns = 0, rows = 0;              // 0: the size of the picture is unknown yet
    int width = 0, height = 0;              // of a tile, pixels
    int64_t frames = 0;                     // compared frames
    int64_t moves = 0;                      // frames after which pieces moved
    int64_t tilesMoved = 0;                 // tiles or chunks that moved
    int64_t taken = 0;                      // frames drawn with another assignment than the previous one
    std::vector<std::pair<int, int>> nodes; // node and its current number of pieces
};

} // namespace mural
