// The proof that an output is alive. The head sends HeadCommand::ProveOutput to all nodes at one position of the
// stream. Each node replies NodeMessage::OutputProof when its replay reaches that position.
#pragma once

#include <cstdint>

namespace mural::wire {

struct ProveOutputCommand {
    uint32_t number; // of the request, from 1
};

struct OutputProofMessage {
    uint32_t number; // of the ProveOutputCommand
    uint32_t client; // program of the latest frame; 0: no frame yet
    uint32_t frame;  // latest frame of that program; of the windows, if the node has windows
    uint32_t reserved;
    uint64_t hash;   // XXH3 of the pixels in the node's windows; 0: it has none
    int64_t shownNs; // when the windows showed the frame, or the frame was complete; monotonic clock of the node
};
static_assert(sizeof(OutputProofMessage) == 32);

} // namespace mural::wire
