#include "compositor/image/pixel_bytes.hpp"

#include <new>
#include <sys/mman.h>

namespace mural::compositor {
namespace {

constexpr size_t kLineBytes = 64, kLargePageBytes = size_t{2} << 20;
constexpr size_t kMostOfSmallPages = 2 * kLargePageBytes; // of less, too much might lie idle at both ends

std::align_val_t alignmentOf(size_t sizeBytes) { return std::align_val_t{sizeBytes < kMostOfSmallPages ? kLineBytes : kLargePageBytes}; }

} // namespace

void* allocatePixels(size_t sizeBytes) {
    void* const at = ::operator new(sizeBytes, alignmentOf(sizeBytes));
    if (sizeBytes >= kMostOfSmallPages) madvise(at, sizeBytes / kLargePageBytes * kLargePageBytes, MADV_HUGEPAGE); // no matter if it can't
    return at;
}

void freePixels(void* at, size_t sizeBytes) { ::operator delete(at, alignmentOf(sizeBytes)); }

} // namespace mural::compositor
