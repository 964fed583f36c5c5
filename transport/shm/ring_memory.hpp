// Memory of one connection: two byte rings, one per direction, and their header. Layout of the mapping: header |
// control of ring 0 | control of ring 1 | data of 0 | data of 1. Side 0 (the creator) writes ring 0 and reads ring 1;
// side 1 does the opposite.
#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "transport/shm/byte_ring.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

class RingMemory {
public:
    // For two ends in one process. Capacity per direction, a power of two.
    static Result<std::shared_ptr<RingMemory>> makePrivate(size_t capacityBytes);
    // For two processes; the other one opens `memfd`. Its size is sealed, so no peer can cause an access fault.
    static Result<std::shared_ptr<RingMemory>> makeShared(size_t capacityBytes, FileDescriptor& memfd);
    static Result<std::shared_ptr<RingMemory>> openShared(int memfd);

    RingMemory(const RingMemory&) = delete;
    RingMemory& operator=(const RingMemory&) = delete;
    ~RingMemory();

    [[nodiscard]] RingControl& control(int ring) const;
    [[nodiscard]] std::byte* data(int ring) const;
    [[nodiscard]] size_t capacityBytes() const { return capacityBytes_; }

private:
    RingMemory(void* base, size_t sizeBytes, size_t capacityBytes)
        : base_(static_cast<std::byte*>(base)), sizeBytes_(sizeBytes), capacityBytes_(capacityBytes) {}
    static Result<std::shared_ptr<RingMemory>> map(int fd, size_t capacityBytes);

    std::byte* base_;
    size_t sizeBytes_;
    size_t capacityBytes_;
};

} // namespace mural
