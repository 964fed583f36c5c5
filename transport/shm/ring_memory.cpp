#include "transport/shm/ring_memory.hpp"

#include <bit>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>

#include "transport/system_error.hpp"

namespace mural {

namespace {

constexpr uint32_t kMagic = 0x4d55525a; // "MURZ"
constexpr uint32_t kVersion = 1;
constexpr size_t kControlBytes = 4096; // header and controls; keeps the data page-aligned
constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

struct alignas(64) Header {
    uint32_t magic;
    uint32_t version;
    uint64_t capacityBytes;
};
static_assert(sizeof(Header) + 2 * sizeof(RingControl) <= kControlBytes);

size_t mappingBytes(size_t capacityBytes) { return kControlBytes + 2 * capacityBytes; }

bool validCapacity(size_t bytes) {
    return std::has_single_bit(bytes) && bytes >= kMinRingBytes && bytes <= kMaxRingBytes;
}

Error badCapacity(size_t bytes) {
    return Error{"shared memory: capacity " + std::to_string(bytes) + " bytes: must be a power of two from " +
                 std::to_string(kMinRingBytes) + " to " + std::to_string(kMaxRingBytes)};
}

} // namespace

Result<std::shared_ptr<RingMemory>> RingMemory::map(int fd, size_t capacityBytes) {
    const size_t sizeBytes = mappingBytes(capacityBytes);
    const int flags = fd < 0 ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED;
    void* base = mmap(nullptr, sizeBytes, PROT_READ | PROT_WRITE, flags, fd, 0);
    if (base == MAP_FAILED) {
        return Error{"shared memory: cannot map " + std::to_string(sizeBytes) + " bytes: " + errnoText(errno) +
                     "; use a smaller capacity"};
    }
    return std::shared_ptr<RingMemory>(new RingMemory(base, sizeBytes, capacityBytes));
}

Result<std::shared_ptr<RingMemory>> RingMemory::makePrivate(size_t capacityBytes) {
    if (!validCapacity(capacityBytes)) return badCapacity(capacityBytes);
    return map(-1, capacityBytes);
}

Result<std::shared_ptr<RingMemory>> RingMemory::makeShared(size_t capacityBytes, FileDescriptor& memfd) {
    if (!validCapacity(capacityBytes)) return badCapacity(capacityBytes);
    FileDescriptor fd(memfd_create("mural-connection", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!fd.valid()) {
        return Error{"shared memory: memfd_create: " + errnoText(errno) +
                     "; raise the limit of open files (ulimit -n)"};
    }
    if (ftruncate(fd.get(), static_cast<off_t>(mappingBytes(capacityBytes))) != 0 ||
        fcntl(fd.get(), F_ADD_SEALS, kSeals) != 0) {
        return Error{"shared memory: cannot set the size of a memfd: " + errnoText(errno)};
    }
    auto memory = map(fd.get(), capacityBytes);
    if (!memory) return memory.error();
    *reinterpret_cast<Header*>((*memory)->base_) = {kMagic, kVersion, capacityBytes};
    memfd = std::move(fd);
    return memory;
}

Result<std::shared_ptr<RingMemory>> RingMemory::openShared(int memfd) {
    const int seals = fcntl(memfd, F_GET_SEALS);
    if (seals < 0 || (seals & F_SEAL_SHRINK) == 0) {
        return Error{"shared memory: descriptor " + std::to_string(memfd) +
                     " is not the memory of a Mural connection; use one build at both ends"};
    }
    struct stat status {};
    Header header{};
    if (fstat(memfd, &status) != 0 || pread(memfd, &header, sizeof header, 0) != sizeof header) {
        return Error{"shared memory: cannot read its header: " + errnoText(errno)};
    }
    if (header.magic != kMagic || header.version != kVersion) {
        return Error{"shared memory: unknown layout (version " + std::to_string(header.version) + ", this build has " +
                     std::to_string(kVersion) + "); use one build at both ends"};
    }
    if (!validCapacity(header.capacityBytes)) return badCapacity(header.capacityBytes);
    if (static_cast<uint64_t>(status.st_size) < mappingBytes(header.capacityBytes)) {
        return Error{"shared memory: " + std::to_string(status.st_size) +
                     " bytes are too few for its capacity; use one build at both ends"};
    }
    return map(memfd, header.capacityBytes);
}

RingMemory::~RingMemory() { munmap(base_, sizeBytes_); }

RingControl& RingMemory::control(int ring) const {
    return reinterpret_cast<RingControl*>(base_ + sizeof(Header))[ring];
}

std::byte* RingMemory::data(int ring) const {
    return base_ + kControlBytes + static_cast<size_t>(ring) * capacityBytes_;
}

} // namespace mural
