// Anonymous files (memfd) that become unchangeable. Other processes may map them without trust in their creator: the
// kernel guarantees that neither contents nor size change.
#pragma once

#include "objects/blob/blob_memory.hpp"

namespace mural::objects {

class SealedMemory {
public:
    SealedMemory() = default;
    SealedMemory(const SealedMemory&) = delete;
    SealedMemory& operator=(const SealedMemory&) = delete;
    ~SealedMemory();

    // Creates memory of zeros and returns it for writing; empty without a free descriptor or without memory.
    std::span<std::byte> create(size_t sizeBytes);
    // Ends writing and maps the memory for reading. Returns false if the kernel refuses.
    bool seal();
    // Creates memory with these contents, sealed. Writes without a mapping, which saves the page faults.
    bool createFrom(std::span<const std::byte> contents);

    // Maps a sealed descriptor of the given size for reading. Returns false, with `problem`, if it is something else.
    bool adopt(FileDescriptor descriptor, size_t sizeBytes, uint64_t inode, std::string& problem);

    // Gives mapping and descriptor away. Requires sealed memory.
    void moveInto(Blob::Memory& memory);

private:
    bool createFile(size_t sizeBytes);
    bool sealFile();
    bool mapForReading();

    FileDescriptor descriptor_;
    void* mapping_ = nullptr;
    size_t sizeBytes_ = 0;
};

} // namespace mural::objects
