#include "objects/blob/blob_assembly.hpp"

namespace mural::objects {

bool BlobAssembly::add(uint64_t offset, std::span<const std::byte> bytes) {
    if (offset > receivedBytes() || bytes.size() > sizeBytes_ || offset > sizeBytes_ - bytes.size()) return false;
    const uint64_t known = receivedBytes() - offset;
    if (known < bytes.size())
        received_.insert(received_.end(), bytes.begin() + static_cast<std::ptrdiff_t>(known), bytes.end());
    return true;
}

Result<Blob> BlobAssembly::finish() {
    Result<Blob> blob = Blob::copyOf(received_);
    if (blob && blob->name() != name_)
        return Error{"blob " + textOf(name_) + " of " + std::to_string(sizeBytes_) +
                     " bytes arrived damaged; it must be sent again"};
    return blob;
}

} // namespace mural::objects
