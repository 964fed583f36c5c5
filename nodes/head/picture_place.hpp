// What a node's picture is on the wall: frames of a configuration may have made it smaller on its way, or show it elsewhere and in another size
// than it was drawn.
#pragma once

#include "common/result.hpp"
#include "nodes/head/byte_buffer.hpp"
#include "nodes/head/node_plan.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

struct PlacedPicture {
    wire::PictureHeader header{}; // where it is shown
    ByteBuffer rows;              // as many as that has
};

// rows: as they came, of the size that the node's pictures have on their way. Errors: no size that a picture has, or no memory.
Result<PlacedPicture> placeOnWall(const NodePlan& node, const wire::PictureHeader& header, ByteBuffer rows);

} // namespace mural
