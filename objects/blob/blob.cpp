#include <mural/blob.hpp>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <xxhash.h>

#include "objects/blob/blob_memory.hpp"
#include "objects/blob/sealed_memory.hpp"

namespace mural {

namespace {

Error noMemoryFor(size_t sizeBytes) {
    return {"no memory for a blob of " + std::to_string(sizeBytes) + " bytes; free memory or use smaller blobs"};
}

Error fileError(const std::string& path, const char* problem) { return {"cannot map " + path + ": " + problem}; }

} // namespace

Blob::Memory::~Memory() {
    if (mapping) ::munmap(mapping, bytes.size());
}

std::span<const std::byte> Blob::bytes() const { return memory_ ? memory_->bytes : std::span<const std::byte>(); }

const BlobName& Blob::name() const {
    static const BlobName ofNothing = objects::blobNameOf({});
    return memory_ ? memory_->name : ofNothing;
}

Result<Blob> Blob::copyOf(std::span<const std::byte> bytes) {
    if (bytes.empty()) return Blob();
    auto memory = std::make_shared<Memory>();
    memory->name = objects::blobNameOf(bytes);
    if (bytes.size() >= objects::kMinSharedBlobBytes) {
        objects::SealedMemory sealed;
        if (sealed.createFrom(bytes)) {
            sealed.moveInto(*memory);
            return Blob(std::move(memory));
        }
    }
    memory->heap.reset(new (std::nothrow) std::byte[bytes.size()]);
    if (!memory->heap) return noMemoryFor(bytes.size());
    std::memcpy(memory->heap.get(), bytes.data(), bytes.size());
    memory->bytes = {memory->heap.get(), bytes.size()};
    return Blob(std::move(memory));
}

Result<Blob> Blob::make(size_t sizeBytes, const std::function<void(std::span<std::byte>)>& fill) {
    if (sizeBytes == 0) return Blob();
    auto memory = std::make_shared<Memory>();
    if (sizeBytes >= objects::kMinSharedBlobBytes) {
        objects::SealedMemory sealed;
        if (const auto room = sealed.create(sizeBytes); !room.empty()) {
            fill(room);
            if (!sealed.seal()) return noMemoryFor(sizeBytes);
            sealed.moveInto(*memory);
            memory->name = objects::blobNameOf(memory->bytes);
            return Blob(std::move(memory));
        }
    }
    memory->heap.reset(new (std::nothrow) std::byte[sizeBytes]());
    if (!memory->heap) return noMemoryFor(sizeBytes);
    fill({memory->heap.get(), sizeBytes});
    memory->bytes = {memory->heap.get(), sizeBytes};
    memory->name = objects::blobNameOf(memory->bytes);
    return Blob(std::move(memory));
}

Result<Blob> Blob::mapFile(const std::string& path) {
    const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.valid()) return fileError(path, std::strerror(errno));
    struct stat before {
    }, after{};
    if (::fstat(file.get(), &before) != 0) return fileError(path, std::strerror(errno));
    if (!S_ISREG(before.st_mode)) return fileError(path, "it is no regular file");
    if (before.st_size == 0) return Blob();
    auto memory = std::make_shared<Memory>();
    const auto sizeBytes = static_cast<size_t>(before.st_size);
    void* const mapping = ::mmap(nullptr, sizeBytes, PROT_READ, MAP_SHARED, file.get(), 0);
    if (mapping == MAP_FAILED) return fileError(path, std::strerror(errno));
    memory->mapping = mapping;
    memory->bytes = {static_cast<const std::byte*>(mapping), sizeBytes};
    memory->name = objects::blobNameOf(memory->bytes);
    if (::fstat(file.get(), &after) != 0 || after.st_size != before.st_size)
        return fileError(path, "its size changed meanwhile; map it after it is written");
    return Blob(std::move(memory));
}

namespace objects {

BlobName blobNameOf(std::span<const std::byte> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    BlobName name;
    std::memcpy(name.data(), &hash.low64, 8);
    std::memcpy(name.data() + 8, &hash.high64, 8);
    return name;
}

std::string textOf(const BlobName& name) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (size_t i = 0; i < 8; ++i) {
        text += kDigits[std::to_integer<unsigned>(name[i]) >> 4];
        text += kDigits[std::to_integer<unsigned>(name[i]) & 15];
    }
    return text;
}

} // namespace objects
} // namespace mural
