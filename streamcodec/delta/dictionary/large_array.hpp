// Zero-initialised memory of megabytes that fills slowly and is committed on first use. Uses huge pages where
// available: with pages of 4 KiB, the page faults of a busy stream's log cost more than its contents. The first part is
// committed in advance, because every program uses it and its faults take longer than most frames.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <sys/mman.h>
#include <type_traits>

#include "common/memory/huge_pages.hpp"

namespace mural::delta {

template <class T> class LargeArray {
public:
    static_assert(std::is_trivially_copyable_v<T>);

    // Returns an empty array without memory. `readyBytes` are committed in advance.
    static LargeArray tryMake(size_t size, size_t readyBytes = kHugePageBytes) {
        LargeArray array;
        const size_t sizeBytes = size * sizeof(T), spare = sizeBytes >= kHugePageBytes ? kHugePageBytes : 0;
        void* const mapped = mmap(nullptr, sizeBytes + spare, PROT_READ | PROT_WRITE,
                                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (mapped == MAP_FAILED) return array;
        array.mapped_ = {static_cast<std::byte*>(mapped), Unmap{sizeBytes + spare}};
        std::byte* from = array.mapped_.get();
        if (spare != 0) {
            from = requestHugePages({from, sizeBytes + spare}).data();
            // failure is harmless
            madvise(from, std::min(readyBytes, sizeBytes / kHugePageBytes * kHugePageBytes), MADV_POPULATE_WRITE);
        }
        array.data_ = reinterpret_cast<T*>(from);
        return array;
    }
    static LargeArray make(size_t size) {
        LargeArray array = tryMake(size);
        if (!array) throw std::bad_alloc();
        return array;
    }

    explicit operator bool() const { return data_ != nullptr; }
    [[nodiscard]] T* data() { return data_; }
    [[nodiscard]] const T* data() const { return data_; }
    T& operator[](size_t i) { return data_[i]; }
    const T& operator[](size_t i) const { return data_[i]; }

private:
    struct Unmap {
        size_t sizeBytes = 0;
        void operator()(std::byte* mapped) const { munmap(mapped, sizeBytes); }
    };
    std::unique_ptr<std::byte, Unmap> mapped_;
    T* data_ = nullptr;
};

} // namespace mural::delta
