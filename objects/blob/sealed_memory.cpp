#include "objects/blob/sealed_memory.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

namespace mural::objects {

namespace {

constexpr int kSeals = F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW;

bool writeAll(int file, std::span<const std::byte> contents) {
    while (!contents.empty()) {
        const ssize_t written = ::write(file, contents.data(), contents.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        contents = contents.subspan(static_cast<size_t>(written));
    }
    return true;
}

} // namespace

SealedMemory::~SealedMemory() {
    if (mapping_) ::munmap(mapping_, sizeBytes_);
}

bool SealedMemory::createFile(size_t sizeBytes) {
    descriptor_ = FileDescriptor(::memfd_create("mural-blob", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    sizeBytes_ = sizeBytes;
    return descriptor_.valid();
}

std::span<std::byte> SealedMemory::create(size_t sizeBytes) {
    if (!createFile(sizeBytes) || ::ftruncate(descriptor_.get(), static_cast<off_t>(sizeBytes)) != 0) return {};
    void* const mapping = ::mmap(nullptr, sizeBytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.get(), 0);
    if (mapping == MAP_FAILED) return {};
    mapping_ = mapping;
    return {static_cast<std::byte*>(mapping), sizeBytes};
}

bool SealedMemory::seal() {
    if (mapping_) ::munmap(std::exchange(mapping_, nullptr), sizeBytes_); // F_SEAL_WRITE requires it
    return sealFile() && mapForReading();
}

bool SealedMemory::createFrom(std::span<const std::byte> contents) {
    return createFile(contents.size()) && writeAll(descriptor_.get(), contents) && sealFile() && mapForReading();
}

bool SealedMemory::adopt(FileDescriptor descriptor, size_t sizeBytes, uint64_t inode, std::string& problem) {
    struct stat found {};
    if (::fstat(descriptor.get(), &found) != 0) {
        problem = std::strerror(errno);
    } else if (!S_ISREG(found.st_mode) || found.st_ino != inode) {
        problem = "the descriptor belongs to another file by now";
    } else if (found.st_size < 0 || static_cast<uint64_t>(found.st_size) != sizeBytes) {
        problem = "it has " + std::to_string(found.st_size) + " bytes";
    } else if (const int seals = ::fcntl(descriptor.get(), F_GET_SEALS); seals < 0 || (seals & kSeals) != kSeals) {
        problem = "its memory is not sealed";
    } else {
        descriptor_ = std::move(descriptor);
        sizeBytes_ = sizeBytes;
        if (mapForReading()) return true;
        problem = std::strerror(errno);
    }
    return false;
}

bool SealedMemory::sealFile() { return ::fcntl(descriptor_.get(), F_ADD_SEALS, kSeals) == 0; }

bool SealedMemory::mapForReading() {
    void* const mapping = ::mmap(nullptr, sizeBytes_, PROT_READ, MAP_SHARED, descriptor_.get(), 0);
    if (mapping == MAP_FAILED) return false;
    mapping_ = mapping;
    return true;
}

void SealedMemory::moveInto(Blob::Memory& memory) {
    memory.mapping = std::exchange(mapping_, nullptr);
    memory.bytes = {static_cast<const std::byte*>(memory.mapping), sizeBytes_};
    memory.descriptor = std::move(descriptor_);
}

} // namespace mural::objects
