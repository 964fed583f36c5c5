#include "economy/pixel_words.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "economy/pixel_words.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::economy::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kMostLanes = kPieceWordRoom - kPieceWords;
constexpr size_t kSamples = 8, kSampleBytes = 32, kSampleStep = (kPageBytes - 2 * kSampleBytes) / kSamples;

#if HWY_TARGET == HWY_SCALAR // no vectors

// Of each byte as a signed number its magnitude, at most 31, and 8 for not being 0.
void roughnessVectors(const uint8_t* piece, uint32_t* roughnesses) {
    for (size_t k = 0; k < kPixelBytes.size(); ++k) {
        roughnesses[k] = 0;
        for (size_t i = 0; i < kSamples * kSampleBytes; ++i) {
            const uint8_t* const at = piece + kSampleBytes + i / kSampleBytes * kSampleStep + i % kSampleBytes;
            const auto difference = static_cast<uint8_t>(*at - (kPixelBytes[k] == 0 ? 0 : *(at - kPixelBytes[k])));
            const uint32_t magnitude = difference < 128 ? difference : 256u - difference;
            roughnesses[k] += magnitude == 0 ? 0 : (magnitude < 31 ? magnitude : 31) + 8;
        }
    }
}

// In front of the piece stand zeros for one pixel.
size_t differencesVectors(const uint8_t* piece, size_t pixelBytes, uint32_t* words, uint8_t* mask) {
    size_t count = 0;
    for (size_t i = 0; i < kPieceWords; ++i) {
        uint8_t bytes[4];
        for (size_t b = 0; b < 4; ++b) bytes[b] = static_cast<uint8_t>(piece[4 * i + b] - *(piece + 4 * i + b - pixelBytes));
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

void roughnessVectors(const uint8_t* piece, uint32_t* roughnesses) {
    const hn::CappedTag<uint8_t, kSampleBytes> d;
    const hn::RepartitionToWide<hn::RepartitionToWide<hn::RepartitionToWide<decltype(d)>>> sumOf;
    const auto none = hn::Zero(d), most = hn::Set(d, 31), there = hn::Set(d, 8);
    for (size_t k = 0; k < kPixelBytes.size(); ++k) {
        auto sum = hn::Zero(sumOf);
        for (size_t s = 0; s < kSamples; ++s) {
            for (size_t i = 0; i < kSampleBytes; i += hn::Lanes(d)) {
                const uint8_t* const at = piece + kSampleBytes + s * kSampleStep + i;
                const auto now = hn::LoadU(d, at);
                const auto difference = kPixelBytes[k] == 0 ? now : hn::Sub(now, hn::LoadU(d, at - kPixelBytes[k]));
                const auto magnitude = hn::Min(hn::Min(difference, hn::Sub(none, difference)), most);
                sum = hn::Add(sum, hn::SumsOf8(hn::Add(magnitude, hn::IfThenZeroElse(hn::Eq(difference, none), there))));
            }
        }
        roughnesses[k] = static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(sumOf, sum)));
    }
}

size_t differencesVectors(const uint8_t* piece, size_t pixelBytes, uint32_t* words, uint8_t* mask) {
    size_t count = 0;
    const hn::CappedTag<uint32_t, kMostLanes> d; // stored whole
    const hn::Repartition<uint8_t, decltype(d)> bytes;
    const size_t lanes = hn::Lanes(d);
    for (size_t i = 0; i < kPieceWords; i += lanes) {
        const uint8_t* const at = piece + 4 * i;
        const auto changed = hn::BitCast(d, hn::Sub(hn::LoadU(bytes, at), hn::LoadU(bytes, at - pixelBytes)));
        const auto there = hn::Ne(changed, hn::Zero(d));
        uint8_t bits[8] = {};
        if (!hn::AllFalse(d, there)) { // where pictures are even, nothing changes for long
            hn::StoreU(hn::Compress(changed, there), d, words + count);
            count += hn::CountTrue(d, there);
            hn::StoreMaskBits(d, there, bits);
        }
        if (lanes >= 8) std::memcpy(mask + i / 8, bits, lanes / 8);
        else mask[i / 8] = static_cast<uint8_t>((i % 8 == 0 ? 0 : mask[i / 8]) | bits[0] << i % 8);
    }
    return count;
}

// How many words are done.
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
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) hn::StoreInterleaved4(plane(0), plane(1), plane(2), plane(3), d, words + 4 * i);
    return i;
}

#endif

} // namespace mural::economy::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::economy {

HWY_EXPORT(roughnessVectors);
HWY_EXPORT(differencesVectors);
HWY_EXPORT(toPlanesVectors);
HWY_EXPORT(fromPlanesVectors);

namespace {

constexpr size_t kInFront = 16; // zeros before the first pixel
static_assert(kInFront >= kPixelBytes.back());

uint8_t* bytesOf(std::byte* bytes) { return reinterpret_cast<uint8_t*>(bytes); }
const uint8_t* bytesOf(const std::byte* bytes) { return reinterpret_cast<const uint8_t*>(bytes); }

// All bytes of both by themselves.
template <class Word> Word added(Word a, Word b) {
    constexpr auto kTop = static_cast<Word>(0x8080808080808080);
    return static_cast<Word>(((a & ~kTop) + (b & ~kTop)) ^ ((a ^ b) & kTop));
}

// A pixel has as many bytes as a Word.
template <class Word> void sum(const uint8_t* differences, uint8_t* piece) {
    Word pixel = 0;
    for (size_t i = 0; i < kPageBytes; i += sizeof pixel) {
        Word difference = 0;
        std::memcpy(&difference, differences + i, sizeof difference);
        pixel = added(pixel, difference);
        std::memcpy(piece + i, &pixel, sizeof pixel);
    }
}

// The byte behind each pixel is written again with the next one.
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

std::array<uint32_t, kPixelBytes.size()> roughness(const std::byte* piece) {
    std::array<uint32_t, kPixelBytes.size()> result{};
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
        for (size_t k = 0; k < 8; ++k, bits >>= 1) { // no branch: nobody could foresee it
            const uint32_t bit = bits & 1;
            all[i + k] = *words & (0 - bit);
            words += bit;
        }
    }
    const auto* const from = reinterpret_cast<const uint8_t*>(all);
    if (pixelBytes == 1) sum<uint8_t>(from, bytesOf(piece));
    else if (pixelBytes == 2) sum<uint16_t>(from, bytesOf(piece));
    else if (pixelBytes == 3) sumTriples(from, bytesOf(piece));
    else if (pixelBytes == 4) sum<uint32_t>(from, bytesOf(piece));
    else sum<uint64_t>(from, bytesOf(piece));
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

} // namespace mural::economy
#endif
