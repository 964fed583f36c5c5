#include "objects/blob/blob_store.hpp"

namespace mural::objects {

namespace {

constexpr size_t kVisitsPerInsert = 64; // bounds the cost of an insertion while most blobs are in use

} // namespace

Blob BlobStore::insert(const Blob& blob) {
    if (blob.empty()) return blob;
    const auto [at, isNew] = entries_.try_emplace(blob.name(), Entry{blob});
    if (!isNew) return at->second.blob;
    sizeBytes_ += blob.sizeBytes();
    if (sizeBytes_ > mostBytes_) trim(kVisitsPerInsert);
    return blob;
}

Blob BlobStore::find(const BlobName& name) {
    const auto found = entries_.find(name);
    if (found == entries_.end()) return {};
    found->second.isRecent = true;
    return found->second.blob;
}

void BlobStore::trim(size_t visits) {
    auto at = entries_.upper_bound(hand_);
    for (; visits > 0 && sizeBytes_ > mostBytes_ && !entries_.empty(); --visits) {
        if (at == entries_.end()) at = entries_.begin();
        hand_ = at->first;
        Entry& entry = at->second;
        if (entry.blob.memory().use_count() > 1) {
            ++at;
        } else if (entry.isRecent) {
            entry.isRecent = false;
            ++at;
        } else {
            sizeBytes_ -= entry.blob.sizeBytes();
            at = entries_.erase(at);
        }
    }
}

} // namespace mural::objects
