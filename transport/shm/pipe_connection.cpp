// A connection with both ends in one process.
#include <algorithm>
#include <bit>

#include "transport/shm/ring_connection.hpp"

namespace mural {

Result<PipePair> makePipe(size_t capacityBytes) {
    auto memory = RingMemory::makePrivate(std::bit_ceil(std::clamp(capacityBytes, kMinRingBytes, kMaxRingBytes)));
    if (!memory) return memory.error();
    PipePair pair;
    pair.a = std::make_unique<RingConnection>(*memory, 0, FileDescriptor(), "pipe:");
    pair.b = std::make_unique<RingConnection>(*memory, 1, FileDescriptor(), "pipe:");
    return pair;
}

} // namespace mural
