// Bytes of pixels that begin with a line of the cache, so that vectors do not lie across two: std::vector's own begin 16 bytes
// behind one where they are large. Whole pictures ask for large pages: kernels that wait for memory are a sixth to a third faster.
#pragma once

#include <cstddef>
#include <vector>

namespace mural::compositor {

// Throws std::bad_alloc. What one returns the other takes back, with the same size.
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
