// A blob that arrives in pieces.
#pragma once

#include <vector>

#include "objects/blob/blob_memory.hpp"

namespace mural::objects {

class BlobAssembly {
public:
    // Memory is allocated with the pieces, except address space.
    BlobAssembly(const BlobName& name, uint64_t sizeBytes) : name_(name), sizeBytes_(sizeBytes) {}

    // Adds the bytes at `offset`. Returns false if they do not continue the received bytes, which then stay unchanged.
    // A repeated part is accepted and ignored.
    bool add(uint64_t offset, std::span<const std::byte> bytes);

    [[nodiscard]] std::span<const std::byte> received() const { return received_; }
    [[nodiscard]] uint64_t receivedBytes() const { return received_.size(); }
    [[nodiscard]] uint64_t sizeBytes() const { return sizeBytes_; }
    [[nodiscard]] bool isComplete() const { return receivedBytes() == sizeBytes_; }
    // Verifies the name and returns the blob. Requires isComplete(). Errors: the bytes are damaged, out of memory.
    Result<Blob> finish();

private:
    BlobName name_;
    uint64_t sizeBytes_;
    std::vector<std::byte> received_;
};

} // namespace mural::objects
