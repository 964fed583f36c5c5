// Places a node's picture on the wall. The frames of a configuration may scale the picture in transfer, or show it at
// another place and size than drawn.
#pragma once

#include <cstdint>

#include "common/base/result.hpp"
#include "nodes/head/results/byte_buffer.hpp"
#include "nodes/head/planning/node_plan.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

inline constexpr uint32_t kMaxPictureSide = 32768; // pixels; a larger picture is invalid

struct PlacedPicture {
    wire::PictureHeader header{}; // the shown area
    ByteBuffer rows;              // rows of that area
};

// rows: received rows, in the size of the node's pictures in transfer. Errors: an invalid size; out of memory.
Result<PlacedPicture> placeOnWall(const NodePlan& node, const wire::PictureHeader& header, ByteBuffer rows);

} // namespace mural
