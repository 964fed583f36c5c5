// Cache-line aligned memory for pixels, so vectors do not straddle lines: large std::vectors begin 16 bytes after one.
// Whole pictures use huge pages, which make memory-bound kernels a sixth to a third faster.
#pragma once

#include <cstddef>
#include <vector>

namespace mural::compositor {

// Throws std::bad_alloc. Free with the same size.
[[nodiscard]] void* allocatePixels(size_t sizeBytes);
void freePixels(void* at, size_t sizeBytes);

template <class T> struct LineAligned {
    using value_type = T;
    LineAligned() = default;
    template <class U> LineAligned(const LineAligned<U>&) {} // NOLINT(google-explicit-constructor)
    [[nodiscard]] T* allocate(size_t count) { return static_cast<T*>(allocatePixels(count * sizeof(T))); }
    void deallocate(T* at, size_t count) { freePixels(at, count * sizeof(T)); }
    friend bool operator==(const LineAligned&, const LineAligned&) { return true; }
};

using PixelBytes = std::vector<std::byte, LineAligned<std::byte>>;

} // namespace mural::compositor
