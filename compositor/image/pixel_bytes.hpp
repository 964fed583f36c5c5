// Bytes of pixels that begin with a line of the cache, so that vectors do not lie across two: std::vector's own begin 16 bytes
// behind one where they are large.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace mural::compositor {

template <class T> struct LineAligned {
    static constexpr std::align_val_t kLineBytes{64};
    using value_type = T;
    LineAligned() = default;
    template <class U> LineAligned(const LineAligned<U>&) {} // NOLINT(google-explicit-constructor)
    [[nodiscard]] T* allocate(size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLineBytes)); }
    void deallocate(T* at, size_t) { ::operator delete(at, kLineBytes); }
    friend bool operator==(const LineAligned&, const LineAligned&) { return true; }
};

using PixelBytes = std::vector<std::byte, LineAligned<std::byte>>;

} // namespace mural::compositor
