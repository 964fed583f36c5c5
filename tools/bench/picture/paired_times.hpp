// CPU time of this thread relative to memcpy, measured alternately on the same machine state. Buffers change with every
// turn, so data comes from memory, not from the caches.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "common/base/clock.hpp"
#include "compositor/image/pixel_bytes.hpp"

namespace mural::bench {

constexpr size_t kRotatedBytes = size_t{256} << 20; // per set of buffers; exceeds the caches

[[nodiscard]] inline size_t buffersFor(size_t sizeBytes, bool quick) {
    return quick ? 2 : std::max<size_t>(3, kRotatedBytes / std::max<size_t>(sizeBytes, 1));
}

// Buffers are written once, because zero pages are not committed.
class RotatedBuffers {
public:
    RotatedBuffers(size_t count, size_t sizeBytes) : buffers_(count, compositor::PixelBytes(sizeBytes, std::byte{1})) {}
    compositor::PixelBytes& at(size_t turn) { return buffers_[turn % buffers_.size()]; }
    [[nodiscard]] size_t count() const { return buffers_.size(); }

private:
    std::vector<compositor::PixelBytes> buffers_;
};

// Evicts the caches, so the next measurement finds neither its own data nor dirty lines of others: a copy and a kernel
// start equally.
inline void emptyCaches() {
    static const std::vector<std::byte> others(size_t{96} << 20, std::byte{1});
    unsigned sum = 0;
    for (size_t at = 0; at < others.size(); at += 64) sum += std::to_integer<unsigned>(others[at]);
    asm volatile("" : : "r"(sum));
}

template <class Do> double cpuNsOf(Do&& work) {
    const int64_t from = threadCpuNowNs();
    work();
    return static_cast<double>(threadCpuNowNs() - from);
}

[[nodiscard]] inline double medianOf(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace mural::bench
