#include "compositor/selection/tile_class.hpp"

#include <algorithm>
#include <cstring>

#include "compositor/codecs/bitplane/word_arithmetic.hpp"

namespace mural::compositor {

namespace {

constexpr int32_t kSampledAcross = 16, kSampledUp = 12;
constexpr int kSamples = kSampledAcross * kSampledUp;

uint32_t wordAt(const std::byte* at) {
    uint32_t word;
    std::memcpy(&word, at, sizeof word);
    return word;
}

// Returns true if the residual against the word above is small, as in the bit-plane codecs.
bool isClose(bitplane::Arithmetic a, uint32_t word, uint32_t above) {
    const uint32_t residual =
        bitplane::residualOf(a, bitplane::subtract(a, bitplane::turned(a, word), bitplane::turned(a, above)));
    if (a == bitplane::Arithmetic::Bytes) return (residual & 0xf0f0f0f0u) == 0;
    if (a == bitplane::Arithmetic::Halves) return (residual & 0xff00ff00u) == 0;
    return residual < 1u << 16;
}

} // namespace

TileClass classify(const PlaneView& plane) {
    if (plane.width < 2 || plane.height < 2) return {plane.format, Activity::Full, Change::Sharp};
    const bitplane::Arithmetic arithmetic = bitplane::arithmeticOf(plane.format);
    const size_t pixelBytes = bytesPerPixel(plane.format);
    int differ = 0, near = 0, repeated = 0;
    for (int32_t j = 0; j < kSampledUp; ++j)
        for (int32_t i = 0; i < kSampledAcross; ++i) {
            // Staggered samples: in columns a vertical edge would hit all or none.
            const auto y = static_cast<int32_t>(1 + static_cast<int64_t>(plane.height - 2) * j / (kSampledUp - 1));
            const auto x =
                static_cast<int32_t>((static_cast<int64_t>(plane.width) * (i * kSampledUp + j * 5 % kSampledUp)) /
                                     (kSampledAcross * kSampledUp));
            const size_t at = static_cast<size_t>(std::max(x, 1)) * pixelBytes;
            const uint32_t word = wordAt(plane.row(y) + at), above = wordAt(plane.row(y - 1) + at);
            if (word == above) continue;
            ++differ;
            near += isClose(arithmetic, word, above);
            repeated += word == wordAt(plane.row(y) + at - pixelBytes);
        }
    if (differ == 0) return {plane.format, Activity::Empty, Change::Smooth};
    const Activity activity = differ <= kSamples * 3 / 8 ? Activity::Flat : Activity::Full;
    if (repeated * 2 >= differ) return {plane.format, activity, Change::Repeated};
    return {plane.format, activity, near * 8 >= differ * 5 ? Change::Smooth : Change::Sharp};
}

} // namespace mural::compositor
