#include "streamcodec/delta/entropy/green_subtraction.hpp"

#include <cstring>

#include "streamcodec/delta/limits.hpp"
#include "streamcodec/delta/entropy/pixel_filters.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "streamcodec/delta/entropy/green_subtraction.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::delta::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR // no vector instructions

void takeFours(const uint8_t* piece, uint8_t* apart) {
    for (size_t i = 0; i < kPageBytes; ++i)
        apart[i] = static_cast<uint8_t>(piece[i] - (i % 2 == 0 ? piece[i / 4 * 4 + 1] : 0));
}
void putFours(const uint8_t* apart, uint8_t* piece) {
    for (size_t i = 0; i < kPageBytes; ++i)
        piece[i] = static_cast<uint8_t>(apart[i] + (i % 2 == 0 ? apart[i / 4 * 4 + 1] : 0));
}
size_t takeVectors(const uint8_t*, size_t, uint8_t*) { return 0; }
size_t putVectors(const uint8_t*, size_t, uint8_t*) { return 0; }

#else

constexpr size_t kMaxBytes = 64; // largest vector; a piece is a multiple of it
using Fours = hn::CappedTag<uint32_t, kMaxBytes / 4>;
using FourBytes = hn::Repartition<uint8_t, Fours>;

// Returns green in the positions of red and blue.
hn::Vec<FourBytes> greenBeside(hn::Vec<FourBytes> pixels) {
    const Fours d;
    const auto green = hn::ShiftRight<8>(hn::And(hn::BitCast(d, pixels), hn::Set(d, 0xff00)));
    return hn::BitCast(FourBytes(), hn::Or(green, hn::ShiftLeft<16>(green)));
}

void takeFours(const uint8_t* piece, uint8_t* apart) {
    const FourBytes d;
    for (size_t i = 0; i < kPageBytes; i += hn::Lanes(d)) {
        const auto pixels = hn::LoadU(d, piece + i);
        hn::StoreU(hn::Sub(pixels, greenBeside(pixels)), d, apart + i);
    }
}

void putFours(const uint8_t* apart, uint8_t* piece) {
    const FourBytes d;
    for (size_t i = 0; i < kPageBytes; i += hn::Lanes(d)) {
        const auto pixels = hn::LoadU(d, apart + i);
        hn::StoreU(hn::Add(pixels, greenBeside(pixels)), d, piece + i);
    }
}

// Returns the number of pixels processed.
size_t takeVectors(const uint8_t* pixels, size_t count, uint8_t* apart) {
    const hn::ScalableTag<uint8_t> d;
    size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        auto red = hn::Zero(d), green = red, blue = red;
        hn::LoadInterleaved3(d, pixels + 3 * i, red, green, blue);
        hn::StoreU(green, d, apart + i);
        hn::StoreU(hn::Sub(red, green), d, apart + count + i);
        hn::StoreU(hn::Sub(blue, green), d, apart + 2 * count + i);
    }
    return i;
}

size_t putVectors(const uint8_t* apart, size_t count, uint8_t* pixels) {
    const hn::ScalableTag<uint8_t> d;
    size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        const auto green = hn::LoadU(d, apart + i);
        hn::StoreInterleaved3(hn::Add(hn::LoadU(d, apart + count + i), green), green,
                              hn::Add(hn::LoadU(d, apart + 2 * count + i), green), d, pixels + 3 * i);
    }
    return i;
}

#endif

} // namespace mural::delta::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::delta {

HWY_EXPORT(takeFours);
HWY_EXPORT(putFours);
HWY_EXPORT(takeVectors);
HWY_EXPORT(putVectors);

namespace {

struct Threes {
    size_t before, count, behind; // bytes, pixels, bytes
};

Threes threesOf(uint8_t filter) {
    const size_t before = filter - size_t{kColoursOfThree}, count = (kPageBytes - before) / 3;
    return {before, count, kPageBytes - before - 3 * count};
}

uint8_t* bytesOf(std::byte* bytes) { return reinterpret_cast<uint8_t*>(bytes); }
const uint8_t* bytesOf(const std::byte* bytes) { return reinterpret_cast<const uint8_t*>(bytes); }

void takeThrees(const std::byte* piece, const Threes& threes, std::byte* apart) {
    const auto* const pixels = bytesOf(piece + threes.before);
    auto* const to = bytesOf(apart);
    for (size_t i = HWY_DYNAMIC_DISPATCH(takeVectors)(pixels, threes.count, to); i < threes.count; ++i) {
        const uint8_t green = pixels[3 * i + 1];
        to[i] = green;
        to[threes.count + i] = static_cast<uint8_t>(pixels[3 * i] - green);
        to[2 * threes.count + i] = static_cast<uint8_t>(pixels[3 * i + 2] - green);
    }
    std::memcpy(apart + 3 * threes.count, piece, threes.before);
    std::memcpy(apart + kPageBytes - threes.behind, piece + kPageBytes - threes.behind, threes.behind);
}

void putThrees(const std::byte* apart, const Threes& threes, std::byte* piece) {
    const auto* const from = bytesOf(apart);
    auto* const pixels = bytesOf(piece + threes.before);
    for (size_t i = HWY_DYNAMIC_DISPATCH(putVectors)(from, threes.count, pixels); i < threes.count; ++i) {
        const uint8_t green = from[i];
        pixels[3 * i] = static_cast<uint8_t>(from[threes.count + i] + green);
        pixels[3 * i + 1] = green;
        pixels[3 * i + 2] = static_cast<uint8_t>(from[2 * threes.count + i] + green);
    }
    std::memcpy(piece, apart + 3 * threes.count, threes.before);
    std::memcpy(piece + kPageBytes - threes.behind, apart + kPageBytes - threes.behind, threes.behind);
}

} // namespace

void subtractGreen(const std::byte* piece, uint8_t filter, std::byte* apart) {
    if (filter == kColoursOfFour)
        HWY_DYNAMIC_DISPATCH(takeFours)(bytesOf(piece), bytesOf(apart));
    else
        takeThrees(piece, threesOf(filter), apart);
}

void addGreen(const std::byte* apart, uint8_t filter, std::byte* piece) {
    if (filter == kColoursOfFour)
        HWY_DYNAMIC_DISPATCH(putFours)(bytesOf(apart), bytesOf(piece));
    else
        putThrees(apart, threesOf(filter), piece);
}

} // namespace mural::delta
#endif
