#include "compositor/kernels/interleave_pixels.hpp"

#include <cstdint>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/interleave_pixels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // no vectors: the scalar loop does everything

size_t interleaveVectors(uint32_t*, const uint32_t* const*, size_t, size_t) { return 0; }

#else

namespace hn = hwy::HWY_NAMESPACE;

// Handles 2, 3 and 4 parts; returns the number of pixels done per part.
size_t interleaveVectors(uint32_t* row, const uint32_t* const* parts, size_t count, size_t step) {
    size_t i = 0;
    const hn::ScalableTag<uint32_t> d;
    const size_t lanes = hn::Lanes(d);
    const auto part = [&](size_t k) { return hn::LoadU(d, parts[k] + i); };
    for (; step >= 2 && step <= 4 && i + lanes <= count; i += lanes) {
        if (step == 2)
            hn::StoreInterleaved2(part(0), part(1), d, row + 2 * i);
        else if (step == 3)
            hn::StoreInterleaved3(part(0), part(1), part(2), d, row + 3 * i);
        else
            hn::StoreInterleaved4(part(0), part(1), part(2), part(3), d, row + 4 * i);
    }
    return i;
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(interleaveVectors);

namespace {

template <size_t kBytes> void scatter(std::byte* row, const std::byte* part, size_t count, size_t step) {
    for (size_t i = 0; i < count; ++i) std::memcpy(row + i * step * kBytes, part + i * kBytes, kBytes);
}
template <size_t kBytes> void gather(std::byte* part, const std::byte* row, size_t count, size_t step) {
    for (size_t i = 0; i < count; ++i) std::memcpy(part + i * kBytes, row + i * step * kBytes, kBytes);
}

} // namespace

void interleaveRowScalar(std::byte* row, const std::byte* part, size_t count, size_t step, size_t pixelBytes) {
    for (size_t i = 0; i < count; ++i) std::memcpy(row + i * step * pixelBytes, part + i * pixelBytes, pixelBytes);
}

// One store per pixel: memory-bound, because every line of the row is touched.
void interleaveRow(std::byte* row, const std::byte* part, size_t count, size_t step, size_t pixelBytes) {
    if (count == 0) return; // the pointers may be null
    if (step == 1)
        std::memcpy(row, part, count * pixelBytes);
    else if (pixelBytes == 4)
        scatter<4>(row, part, count, step);
    else if (pixelBytes == 8)
        scatter<8>(row, part, count, step);
    else
        scatter<16>(row, part, count, step);
}

void deinterleaveRow(std::byte* part, const std::byte* row, size_t count, size_t step, size_t pixelBytes) {
    if (count == 0) return;
    if (step == 1)
        std::memcpy(part, row, count * pixelBytes);
    else if (pixelBytes == 4)
        gather<4>(part, row, count, step);
    else if (pixelBytes == 8)
        gather<8>(part, row, count, step);
    else
        gather<16>(part, row, count, step);
}

void interleaveParts(std::byte* row, const std::byte* const* parts, size_t count, size_t step) {
    size_t done = 0;
    if (step >= 2 && step <= 4) {
        const uint32_t* words[4] = {};
        for (size_t k = 0; k < step; ++k) words[k] = reinterpret_cast<const uint32_t*>(parts[k]);
        done = HWY_DYNAMIC_DISPATCH(interleaveVectors)(reinterpret_cast<uint32_t*>(row), words, count, step);
    }
    for (size_t k = 0; k < step; ++k)
        interleaveRow(row + (done * step + k) * 4, parts[k] + done * 4, count - done, step, 4);
}

} // namespace mural::compositor
#endif
