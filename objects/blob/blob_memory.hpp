// The memory behind blobs, and the ways to it from other processes of the machine.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>

#include <mural/blob.hpp>

#include "common/ipc/file_descriptor.hpp"

namespace mural {

// Immutable after construction, except for `descriptor`.
struct Blob::Memory {
    Memory() = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory();

    BlobName name{};
    std::span<const std::byte> bytes;
    void* mapping = nullptr; // from mmap; null: on the heap
    std::unique_ptr<std::byte[]> heap;

    // The sealed file that holds the contents; created by placeOf() for blobs that came without one.
    mutable std::mutex descriptorMutex;
    mutable FileDescriptor descriptor;
};

namespace objects {

// Smaller blobs are on the heap: a descriptor and a mapping per blob would cost more than copies.
constexpr size_t kMinSharedBlobBytes = size_t{64} << 10;

BlobName blobNameOf(std::span<const std::byte> bytes);
// Returns the first 16 hexadecimal digits of a name, for messages.
std::string textOf(const BlobName& name);

// Where another process of this machine finds a blob. A process that reuses the descriptor gets another inode.
struct BlobPlace {
    BlobName name{};
    uint64_t sizeBytes = 0;
    int32_t pid = 0;
    int32_t fd = -1;
    uint64_t inode = 0;

    friend bool operator==(const BlobPlace&, const BlobPlace&) = default;
};

// Returns the place of a blob. It is valid while a copy of the Blob exists. Copies the contents of a mapped file at the
// first call. Empty: the blob is small, or this process has no free descriptor; the bytes must be sent.
std::optional<BlobPlace> placeOf(const Blob& blob);

struct OpenOptions {
    // Reads all bytes and compares their hash. Otherwise the size, the seals and the inode are verified, and the name
    // only of blobs up to kMaxVerifiedBytes: hashing costs more than mapping.
    bool verifyName = false;
    // Keeps the descriptor, so that placeOf() returns a place in this process.
    bool keepDescriptor = false;
};
constexpr size_t kMaxVerifiedBytes = size_t{256} << 10;

// Maps a blob of another process. Errors: the process has ended or belongs to another user, the descriptor holds
// something else, the memory is not sealed. The caller then requests the bytes.
Result<Blob> openPlace(const BlobPlace& place, const OpenOptions& options = {});

} // namespace objects
} // namespace mural
