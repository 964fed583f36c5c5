// The complete blobs of a process, up to a number of bytes.
#pragma once

#include <map>

#include "objects/blob/blob_memory.hpp"

namespace mural::objects {

// Blobs that are used elsewhere stay. Beyond the limit, unused ones are dropped by the clock rule: the hand passes a
// blob that was found since its last visit, and drops the others.
class BlobStore {
public:
    explicit BlobStore(uint64_t mostBytes) : mostBytes_(mostBytes) {}

    // Returns the stored blob of this name, which may have been there before.
    Blob insert(const Blob& blob);
    // Returns an empty blob if the name is unknown.
    [[nodiscard]] Blob find(const BlobName& name);
    // Drops unused blobs down to the limit, with at most `visits` steps of the hand.
    void trim(size_t visits);

    [[nodiscard]] uint64_t sizeBytes() const { return sizeBytes_; }
    [[nodiscard]] size_t count() const { return entries_.size(); }

private:
    struct Entry {
        Blob blob;
        bool isRecent = true;
    };
    std::map<BlobName, Entry> entries_;
    BlobName hand_{};
    uint64_t mostBytes_;
    uint64_t sizeBytes_ = 0;
};

} // namespace mural::objects
