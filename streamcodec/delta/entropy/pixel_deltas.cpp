#include "streamcodec/delta/entropy/pixel_deltas.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "streamcodec/delta/entropy/pixel_deltas.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::delta::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kMaxLanes = kPieceWordRoom - kPieceWords;
// Samples start at a pixel of four bytes, and equally often at each colour of pixels of three.
constexpr size_t kSamples = 8, kSampleBytes = kSampledBytes / kSamples, kSampleStep = 500;
static_assert(kSampleStep % 4 == 0 && kSampleStep % 3 != 0 && kSampleBytes + kSamples * kSampleStep + 1 <= kPageBytes);

#if HWY_TARGET == HWY_SCALAR // no vector instructions

// Returns an estimate of a signed byte's bits: its magnitude, at most 31, plus 8 unless it is 0.
uint32_t roughnessOf(uint8_t difference) {
    const uint32_t magnitude = difference < 128 ? difference : 256u - difference;
    return magnitude == 0 ? 0 : (magnitude < 31 ? magnitude : 31) + 8;
}

void roughnessVectors(const uint8_t* piece, uint32_t* roughnesses) {
    for (size_t k = 0; k < kPixelFilters.size(); ++k) roughnesses[k] = 0;
    for (size_t s = 0; s < kSamples * kSampleBytes; ++s) {
        const size_t at = kSampleBytes + s / kSampleBytes * kSampleStep + s % kSampleBytes;
        const auto behind = [piece](size_t byte, size_t pixelBytes) {
            return static_cast<uint8_t>(piece[byte] - piece[byte - pixelBytes]);
        };
        for (size_t k = 0; k < kByteFilters; ++k)
            roughnesses[k] += roughnessOf(kPixelFilters[k] == 0 ? piece[at] : behind(at, kPixelFilters[k]));
        const auto fours =
            static_cast<uint8_t>(at % 2 == 1 ? behind(at, 4) : behind(at, 4) - behind(at / 4 * 4 + 1, 4));
        roughnesses[kByteFilters] += roughnessOf(fours);
        const uint8_t now = behind(at, 3), beside = static_cast<uint8_t>(behind(at + 1, 3) - now);
        for (size_t before = 0; before < 3; ++before) {
            const size_t colour = (at + 3 - before) % 3; // red relative to green; green itself; blue relative to green
            roughnesses[kByteFilters + 1 + before] +=
                (colour == 1 ? roughnessOf(now) : 0) + (colour == 2 ? 0 : roughnessOf(beside));
        }
    }
}

// Zeros for one pixel precede the piece.
size_t differencesVectors(const uint8_t* piece, size_t pixelBytes, uint32_t* words, uint8_t* mask) {
    size_t count = 0;
    for (size_t i = 0; i < kPieceWords; ++i) {
        uint8_t bytes[4];
        for (size_t b = 0; b < 4; ++b)
            bytes[b] = static_cast<uint8_t>(piece[4 * i + b] - *(piece + 4 * i + b - pixelBytes));
        std::memcpy(words + count, bytes, 4);
        const bool changed = words[count] != 0;
        count += changed;
        mask[i / 8] = static_cast<uint8_t>((i % 8 == 0 ? 0 : mask[i / 8]) | changed << i % 8);
    }
    return count;
}

size_t toPlanesVectors(const uint8_t*, size_t, uint8_t*) { return 0; }
size_t fromPlanesVectors(const uint8_t*, size_t, uint8_t*) { return 0; }

#else

// Masks of every third byte, for each vector phase.
constexpr auto kThirds = [] {
    std::array<uint8_t, kSampleBytes + 2> thirds{};
    for (size_t i = 0; i < thirds.size(); i += 3) thirds[i] = 0xff;
    return thirds;
}();

void roughnessVectors(const uint8_t* piece, uint32_t* roughnesses) {
    const hn::CappedTag<uint8_t, kSampleBytes> d;
    const hn::RepartitionToWide<hn::RepartitionToWide<hn::RepartitionToWide<decltype(d)>>> sumOf;
    const hn::Repartition<uint32_t, decltype(d)> pixels;
    const auto none = hn::Zero(d), maximum = hn::Set(d, 31), there = hn::Set(d, 8);
    const auto roughnessOf = [&](hn::Vec<decltype(d)> difference) {
        const auto magnitude = hn::Min(hn::Min(difference, hn::Sub(none, difference)), maximum);
        return hn::Add(magnitude, hn::IfThenZeroElse(hn::Eq(difference, none), there));
    };
    const auto behind = [&](const uint8_t* at, size_t pixelBytes) {
        return hn::Sub(hn::LoadU(d, at), hn::LoadU(d, at - pixelBytes));
    };
    const auto forSamples = [&](size_t k, auto&& vectorOf) {
        auto sum = hn::Zero(sumOf);
        for (size_t s = 0; s < kSamples; ++s)
            for (size_t i = 0; i < kSampleBytes; i += hn::Lanes(d))
                sum = hn::Add(sum, vectorOf(kSampleBytes + s * kSampleStep + i));
        roughnesses[k] = static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(sumOf, sum)));
    };
    forSamples(0, [&](size_t at) { return hn::SumsOf8(roughnessOf(hn::LoadU(d, piece + at))); });
    for (size_t k = 1; k < kByteFilters; ++k)
        forSamples(k, [&](size_t at) { return hn::SumsOf8(roughnessOf(behind(piece + at, kPixelFilters[k]))); });
    forSamples(kByteFilters, [&](size_t at) {
        const auto changed = behind(piece + at, 4);
        const auto green = hn::ShiftRight<8>(hn::And(hn::BitCast(pixels, changed), hn::Set(pixels, 0xff00)));
        return hn::SumsOf8(roughnessOf(hn::Sub(changed, hn::BitCast(d, hn::Or(green, hn::ShiftLeft<16>(green))))));
    });
    for (size_t before = 0; before < 3; ++before) {
        // red relative to green; green itself; blue relative to green
        forSamples(kByteFilters + 1 + before, [&](size_t at) {
            const auto now = behind(piece + at, 3), beside = hn::Sub(behind(piece + at + 1, 3), now);
            const auto greens = hn::LoadU(d, kThirds.data() + (at + 2 - before) % 3),
                       blues = hn::LoadU(d, kThirds.data() + (at + 1 - before) % 3);
            return hn::Add(hn::SumsOf8(hn::And(greens, roughnessOf(now))),
                           hn::SumsOf8(hn::AndNot(blues, roughnessOf(beside))));
        });
    }
}

size_t differencesVectors(const uint8_t* piece, size_t pixelBytes, uint32_t* words, uint8_t* mask) {
    size_t count = 0;
    const hn::CappedTag<uint32_t, kMaxLanes> d; // stores whole vectors
    const hn::Repartition<uint8_t, decltype(d)> bytes;
    const size_t lanes = hn::Lanes(d);
    for (size_t i = 0; i < kPieceWords; i += lanes) {
        const uint8_t* const at = piece + 4 * i;
        const auto changed = hn::BitCast(d, hn::Sub(hn::LoadU(bytes, at), hn::LoadU(bytes, at - pixelBytes)));
        const auto there = hn::Ne(changed, hn::Zero(d));
        uint8_t bits[8] = {};
        if (!hn::AllFalse(d, there)) { // uniform areas have long runs without changes
            hn::StoreU(hn::Compress(changed, there), d, words + count);
            count += hn::CountTrue(d, there);
            hn::StoreMaskBits(d, there, bits);
        }
        if (lanes >= 8)
            std::memcpy(mask + i / 8, bits, lanes / 8);
        else
            mask[i / 8] = static_cast<uint8_t>((i % 8 == 0 ? 0 : mask[i / 8]) | bits[0] << i % 8);
    }
    return count;
}

// Returns the number of words processed.
size_t toPlanesVectors(const uint8_t* words, size_t count, uint8_t* planes) {
    size_t i = 0;
    const hn::ScalableTag<uint8_t> d;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        auto first = hn::Zero(d), second = first, third = first, fourth = first;
        hn::LoadInterleaved4(d, words + 4 * i, first, second, third, fourth);
        hn::StoreU(first, d, planes + i);
        hn::StoreU(second, d, planes + count + i);
        hn::StoreU(third, d, planes + 2 * count + i);
        hn::StoreU(fourth, d, planes + 3 * count + i);
    }
    return i;
}

size_t fromPlanesVectors(const uint8_t* planes, size_t count, uint8_t* words) {
    size_t i = 0;
    const hn::ScalableTag<uint8_t> d;
    const auto plane = [&](size_t p) { return hn::LoadU(d, planes + p * count + i); };
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d))
        hn::StoreInterleaved4(plane(0), plane(1), plane(2), plane(3), d, words + 4 * i);
    return i;
}

#endif

} // namespace mural::delta::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::delta {

HWY_EXPORT(roughnessVectors);
HWY_EXPORT(differencesVectors);
HWY_EXPORT(toPlanesVectors);
HWY_EXPORT(fromPlanesVectors);

namespace {

constexpr size_t kInFront = 16; // zero bytes before the first pixel
static_assert(kInFront >= kPixelFilters[kByteFilters - 1]);

uint8_t* bytesOf(std::byte* bytes) { return reinterpret_cast<uint8_t*>(bytes); }
const uint8_t* bytesOf(const std::byte* bytes) { return reinterpret_cast<const uint8_t*>(bytes); }

// Adds bytes without carry between them.
template <class Word> Word added(Word a, Word b) {
    constexpr auto kTop = static_cast<Word>(0x8080808080808080);
    return static_cast<Word>(((a & ~kTop) + (b & ~kTop)) ^ ((a ^ b) & kTop));
}

// Requires pixels of the size of Word.
template <class Word> void sum(const uint8_t* differences, uint8_t* piece) {
    Word pixel = 0;
    for (size_t i = 0; i < kPageBytes; i += sizeof pixel) {
        Word difference = 0;
        std::memcpy(&difference, differences + i, sizeof difference);
        pixel = added(pixel, difference);
        std::memcpy(piece + i, &pixel, sizeof pixel);
    }
}

// Writes four bytes per pixel; the next pixel overwrites the fourth.
void sumTriples(const uint8_t* differences, uint8_t* piece) {
    uint32_t pixel = 0;
    size_t i = 0;
    for (; i + sizeof pixel <= kPageBytes; i += 3) {
        uint32_t difference = 0;
        std::memcpy(&difference, differences + i, sizeof difference);
        pixel = added(pixel, difference);
        std::memcpy(piece + i, &pixel, sizeof pixel);
    }
    for (; i < kPageBytes; ++i) piece[i] = static_cast<uint8_t>(piece[i - 3] + differences[i]);
}

} // namespace

Roughness roughness(const std::byte* piece) {
    Roughness result{};
    HWY_DYNAMIC_DISPATCH(roughnessVectors)(bytesOf(piece), result.data());
    return result;
}

size_t differences(const std::byte* piece, size_t pixelBytes, uint32_t* words, std::byte* mask) {
    alignas(64) uint8_t behindZeros[kInFront + kPageBytes];
    std::memset(behindZeros, 0, kInFront);
    std::memcpy(behindZeros + kInFront, piece, kPageBytes);
    return HWY_DYNAMIC_DISPATCH(differencesVectors)(behindZeros + kInFront, pixelBytes, words, bytesOf(mask));
}

size_t sumDifferences(const uint32_t* words, const std::byte* mask, size_t pixelBytes, std::byte* piece) {
    const uint32_t* const first = words;
    alignas(8) uint32_t all[kPieceWords];
    for (size_t i = 0; i < kPieceWords; i += 8) {
        auto bits = static_cast<uint32_t>(mask[i / 8]);
        for (size_t k = 0; k < 8; ++k, bits >>= 1) { // branch-free: the branch would be unpredictable
            const uint32_t bit = bits & 1;
            all[i + k] = *words & (0 - bit);
            words += bit;
        }
    }
    const auto* const from = reinterpret_cast<const uint8_t*>(all);
    if (pixelBytes == 1)
        sum<uint8_t>(from, bytesOf(piece));
    else if (pixelBytes == 2)
        sum<uint16_t>(from, bytesOf(piece));
    else if (pixelBytes == 3)
        sumTriples(from, bytesOf(piece));
    else if (pixelBytes == 4)
        sum<uint32_t>(from, bytesOf(piece));
    else
        sum<uint64_t>(from, bytesOf(piece));
    return static_cast<size_t>(words - first);
}

void toPlanes(const uint32_t* words, size_t count, std::byte* planes) {
    const auto* const from = reinterpret_cast<const uint8_t*>(words);
    for (size_t i = HWY_DYNAMIC_DISPATCH(toPlanesVectors)(from, count, bytesOf(planes)); i < count; ++i)
        for (size_t p = 0; p < 4; ++p) bytesOf(planes)[p * count + i] = from[4 * i + p];
}

void fromPlanes(const std::byte* planes, size_t count, uint32_t* words) {
    auto* const to = reinterpret_cast<uint8_t*>(words);
    for (size_t i = HWY_DYNAMIC_DISPATCH(fromPlanesVectors)(bytesOf(planes), count, to); i < count; ++i)
        for (size_t p = 0; p < 4; ++p) to[4 * i + p] = bytesOf(planes)[p * count + i];
}

} // namespace mural::delta
#endif
