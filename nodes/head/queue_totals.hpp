// What a queue has dealt out, for reports.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mural {

struct QueueTotals {
    std::string name;
    bool chunks = false;        // of draws, in columns of one row; else tiles of pixels
    int columns = 0, rows = 0;  // 0: no frame has told yet how large the picture is
    int width = 0, height = 0;  // of a tile, pixels
    int64_t frames = 0;         // that were compared
    int64_t moves = 0;          // after how many of them some moved…
    int64_t tilesMoved = 0;     // …and how many tiles or chunks did
    int64_t taken = 0;          // frames of the window that were divided otherwise than the one before
    std::vector<std::pair<int, int>> nodes; // and how many each has now
};

} // namespace mural
