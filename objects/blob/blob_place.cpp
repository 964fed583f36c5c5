#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "objects/blob/blob_memory.hpp"
#include "objects/blob/sealed_memory.hpp"

namespace mural::objects {

std::optional<BlobPlace> placeOf(const Blob& blob) {
    const auto& memory = blob.memory();
    if (!memory || memory->bytes.size() < kMinSharedBlobBytes) return std::nullopt;
    const std::lock_guard lock(memory->descriptorMutex);
    if (!memory->descriptor.valid()) {
        SealedMemory sealed;
        if (!sealed.createFrom(memory->bytes)) return std::nullopt;
        Blob::Memory copy; // its mapping ends here; the contents stay with the descriptor
        sealed.moveInto(copy);
        memory->descriptor = std::move(copy.descriptor);
    }
    struct stat file {};
    if (::fstat(memory->descriptor.get(), &file) != 0) return std::nullopt;
    return BlobPlace{memory->name, memory->bytes.size(), ::getpid(), memory->descriptor.get(), file.st_ino};
}

Result<Blob> openPlace(const BlobPlace& place, const OpenOptions& options) {
    const auto failed = [&](const std::string& problem) {
        return Error{"cannot map blob " + textOf(place.name) + " of process " + std::to_string(place.pid) + ": " +
                     problem + "; its bytes must be transferred"};
    };
    if (place.sizeBytes == 0 || place.sizeBytes > SIZE_MAX / 2 || place.pid <= 0 || place.fd < 0)
        return failed("the place is invalid");
    const std::string path = "/proc/" + std::to_string(place.pid) + "/fd/" + std::to_string(place.fd);
    // O_NONBLOCK: the path may lead to a pipe or a device if the descriptor has been reused.
    FileDescriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!descriptor.valid()) return failed(std::strerror(errno));
    SealedMemory sealed;
    std::string problem;
    if (!sealed.adopt(std::move(descriptor), place.sizeBytes, place.inode, problem)) return failed(problem);
    auto memory = std::make_shared<Blob::Memory>();
    sealed.moveInto(*memory);
    memory->name = place.name;
    if (!options.keepDescriptor) memory->descriptor = FileDescriptor();
    if ((options.verifyName || place.sizeBytes <= kMaxVerifiedBytes) && blobNameOf(memory->bytes) != place.name)
        return failed("its contents have another name");
    return Blob(std::move(memory));
}

} // namespace mural::objects
