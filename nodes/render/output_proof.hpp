// A node's proof that its output is alive (streamcodec/wire/output_proof.hpp).
#pragma once

#include "nodes/render/windows/shown_tiles.hpp"
#include "streamcodec/wire/output_proof.hpp"

namespace mural {

// The latest frame that the replay has completed.
struct CompletedFrame {
    uint32_t client = 0, frame = 0;
    int64_t atNs = 0; // monotonic clock
};

// shown: null if the node has no windows, or no picture in them yet. Hashes all shown pixels.
[[nodiscard]] wire::OutputProofMessage outputProofOf(const wire::ProveOutputCommand& command,
                                                     const CompletedFrame& completed, const ShownTiles* shown);

} // namespace mural
