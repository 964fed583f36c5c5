#include "compositor/image/pixel_bytes.hpp"

#include <new>

#include "common/memory/huge_pages.hpp"

namespace mural::compositor {
namespace {

constexpr size_t kLineBytes = 64;
constexpr size_t kMaxOfSmallPages = 2 * kHugePageBytes; // below, alignment would waste too much at both ends

std::align_val_t alignmentOf(size_t sizeBytes) {
    return std::align_val_t{sizeBytes < kMaxOfSmallPages ? kLineBytes : kHugePageBytes};
}

} // namespace

void* allocatePixels(size_t sizeBytes) {
    void* const at = ::operator new(sizeBytes, alignmentOf(sizeBytes));
    if (sizeBytes >= kMaxOfSmallPages) requestHugePages({static_cast<std::byte*>(at), sizeBytes});
    return at;
}

void freePixels(void* at, size_t sizeBytes) { ::operator delete(at, alignmentOf(sizeBytes)); }

} // namespace mural::compositor
