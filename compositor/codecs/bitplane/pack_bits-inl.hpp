// Packs 64 bytes to a bit width, for strip_code.cpp; included once per instruction set. Branch-free in the width,
// because widths change from block to block: superfluous output is written and then overwritten.
#if defined(MURAL_PACK_BITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MURAL_PACK_BITS_INL
#undef MURAL_PACK_BITS_INL
#else
#define MURAL_PACK_BITS_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::bitplane::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE

using Bytes16 = hn::Full128<uint8_t>;
using Halves16 = hn::Full128<uint16_t>;
using V16 = hn::Vec<Bytes16>;

// Byte shifts as 16-bit shifts; bits from the neighbour are masked or zero.
HWY_INLINE V16 left(V16 v, int bits) {
    return hn::BitCast(Bytes16(), hn::ShiftLeftSame(hn::BitCast(Halves16(), v), bits));
}
HWY_INLINE V16 right(V16 v, int bits) {
    return hn::BitCast(Bytes16(), hn::ShiftRightSame(hn::BitCast(Halves16(), v), bits));
}

#if HWY_MAX_BYTES >= 32

using Bytes32 = hn::Simd<uint8_t, 32, 0>;
using Halves32 = hn::Simd<uint16_t, 16, 0>;
using V32 = hn::Vec<Bytes32>;
HWY_INLINE V32 left(V32 v, int bits) {
    return hn::BitCast(Bytes32(), hn::ShiftLeftSame(hn::BitCast(Halves32(), v), bits));
}
HWY_INLINE V32 right(V32 v, int bits) {
    return hn::BitCast(Bytes32(), hn::ShiftRightSame(hn::BitCast(Halves32(), v), bits));
}

// 64 bytes as two vectors. Requires a width of 1 to 8.
HWY_INLINE uint8_t* packChannel(const uint8_t* bytes, unsigned width, uint8_t* into) {
    const Bytes32 d;
    const Bytes16 dh;
    const V32 a = hn::Load(d, bytes), b = hn::Load(d, bytes + 32);
    if (width == 8) {
        hn::StoreU(a, d, into);
        hn::StoreU(b, d, into + 32);
        return into + 64;
    }
    const V32 four = hn::Set(d, 0x0f);
    hn::StoreU(hn::Or(hn::And(a, four), left(hn::And(b, four), 4)), d, into);
    const V32 two = hn::Set(d, 3);
    const int shift2 = static_cast<int>(width & 4);
    const V32 x = hn::Or(hn::And(right(a, shift2), two), left(hn::And(right(b, shift2), two), 4));
    hn::StoreU(hn::Or(hn::LowerHalf(dh, x), left(hn::UpperHalf(dh, x), 2)), dh, into + 8 * (width & 4));
    const V32 one = hn::Set(d, 1);
    const int shift1 = static_cast<int>(width & 6);
    const V32 y = hn::Or(hn::And(right(a, shift1), one), left(hn::And(right(b, shift1), one), 4));
    const V16 z = hn::Or(hn::LowerHalf(dh, y), left(hn::UpperHalf(dh, y), 2));
    // only the lower half is used
    hn::StoreU(hn::Or(z, left(hn::ShiftRightBytes<8>(dh, z), 1)), dh, into + 8 * (width & 6));
    return into + 8 * width;
}

using Pairs64 = hn::Simd<uint64_t, 4, 0>;

// Bits of a byte that come from the groups of 4, 2 and 1 bits, and the shifts of the last two. Whole vectors, usable as
// operands.
struct alignas(32) UnpackMasks {
    std::array<uint64_t, 4> four, two, one, up2, down2, up1;
};

constexpr std::array<uint64_t, 4> fourTimes(uint64_t value) { return {value, value, value, value}; }

constexpr UnpackMasks unpackMasksOf(unsigned width) {
    constexpr uint64_t kEachByte = 0x0101010101010101;
    const unsigned up2 = width & 4, up1 = width & 6;
    return {fourTimes(width & 4 ? 0x0f * kEachByte : 0),
            fourTimes(width & 2 ? (3u << up2) * kEachByte : 0),
            fourTimes(width & 1 ? (1u << up1) * kEachByte : 0),
            fourTimes(up2),
            fourTimes(4 - up2),
            fourTimes(up1)};
}

constexpr std::array<UnpackMasks, 8> kUnpackMasks{unpackMasksOf(0), unpackMasksOf(1), unpackMasksOf(2),
                                                  unpackMasksOf(3), unpackMasksOf(4), unpackMasksOf(5),
                                                  unpackMasksOf(6), unpackMasksOf(7)};

struct Channel {
    V32 low, high; // its 64 bytes
};

// 64-bit shifts; bits from neighbours are masked.
HWY_INLINE Channel unpackChannel(const uint8_t*& from, unsigned width) {
    const Bytes32 d;
    const Pairs64 q;
    const uint8_t* at = from;
    from += 8 * width;
    if (width == 8) return {hn::LoadU(d, at), hn::LoadU(d, at + 32)};
    const UnpackMasks& m = kUnpackMasks[width];
    const auto loaded = [&](const std::array<uint64_t, 4>& part) { return hn::Load(q, part.data()); };
    alignas(32) static constexpr uint64_t kTwos[4] = {0, 0, 2, 2}, kOnes[4] = {0, 1, 2, 3}, kOnesHigh[4] = {4, 5, 6, 7};
    uint64_t ones;
    std::memcpy(&ones, at + 8 * (width & 6), sizeof ones);
    const auto p4 = hn::BitCast(q, hn::LoadU(d, at));
    const auto p2 = hn::Shr(hn::BitCast(q, hn::LoadDup128(d, at + 8 * (width & 4))), hn::Load(q, kTwos));
    const auto p1 = hn::Set(q, ones);
    const auto low4 = hn::And(p4, loaded(m.four)), high4 = hn::And(hn::ShiftRight<4>(p4), loaded(m.four));
    const auto low2 = hn::And(hn::Shl(p2, loaded(m.up2)), loaded(m.two)),
               high2 = hn::And(hn::Shr(p2, loaded(m.down2)), loaded(m.two));
    const auto low1 = hn::And(hn::Shl(hn::Shr(p1, hn::Load(q, kOnes)), loaded(m.up1)), loaded(m.one));
    const auto high1 = hn::And(hn::Shl(hn::Shr(p1, hn::Load(q, kOnesHigh)), loaded(m.up1)), loaded(m.one));
    return {hn::BitCast(d, hn::Or(low4, hn::Or(low2, low1))), hn::BitCast(d, hn::Or(high4, hn::Or(high2, high1)))};
}

#else

// 64 bytes as four vectors.
HWY_INLINE uint8_t* packChannel(const uint8_t* bytes, unsigned width, uint8_t* into) {
    const Bytes16 d;
    const V16 a = hn::Load(d, bytes), b = hn::Load(d, bytes + 16), c = hn::Load(d, bytes + 32),
              e = hn::Load(d, bytes + 48);
    if (width == 8) {
        hn::StoreU(a, d, into);
        hn::StoreU(b, d, into + 16);
        hn::StoreU(c, d, into + 32);
        hn::StoreU(e, d, into + 48);
        return into + 64;
    }
    const V16 four = hn::Set(d, 0x0f);
    hn::StoreU(hn::Or(hn::And(a, four), left(hn::And(c, four), 4)), d, into);
    hn::StoreU(hn::Or(hn::And(b, four), left(hn::And(e, four), 4)), d, into + 16);
    const auto fold = [&](V16 mask, int shift) {
        const V16 low = hn::Or(hn::And(right(a, shift), mask), left(hn::And(right(c, shift), mask), 4));
        const V16 high = hn::Or(hn::And(right(b, shift), mask), left(hn::And(right(e, shift), mask), 4));
        return hn::Or(low, left(high, 2));
    };
    hn::StoreU(fold(hn::Set(d, 3), static_cast<int>(width & 4)), d, into + 8 * (width & 4));
    const V16 z = fold(hn::Set(d, 1), static_cast<int>(width & 6));
    hn::StoreU(hn::Or(z, left(hn::ShiftRightBytes<8>(d, z), 1)), d, into + 8 * (width & 6));
    return into + 8 * width;
}

HWY_INLINE const uint8_t* unpackChannel(const uint8_t* from, unsigned width, uint8_t* bytes) {
    const Bytes16 d;
    if (width == 8) {
        for (size_t i = 0; i < 64; i += 16) hn::Store(hn::LoadU(d, from + i), d, bytes + i);
        return from + 64;
    }
    const hn::Full128<uint64_t> d64;
    const V16 four = hn::Set(d, width & 4 ? 0x0f : 0), two = hn::Set(d, width & 2 ? 3 : 0),
              one = hn::Set(d, width & 1 ? 1 : 0);
    const V16 p1 = hn::LoadU(d, from + 8 * (width & 6));
    V16 x = hn::LoadU(d, from + 8 * (width & 4));
    V16 y = hn::BitCast(d, hn::InterleaveLower(d64, hn::BitCast(d64, p1), hn::BitCast(d64, right(p1, 1))));
    const V16 low = hn::LoadU(d, from), high = hn::LoadU(d, from + 16);
    const int shift2 = static_cast<int>(width & 4), shift1 = static_cast<int>(width & 6);
    for (size_t part = 0; part < 4; ++part) {
        const V16 p4 = part == 0 ? low : part == 1 ? high : right(part == 2 ? low : high, 4);
        hn::Store(hn::Or(hn::And(p4, four), hn::Or(left(hn::And(x, two), shift2), left(hn::And(y, one), shift1))), d,
                  bytes + 16 * part);
        x = right(x, 2);
        y = right(y, 2);
    }
    return from + 8 * width;
}

#endif
#endif

} // namespace mural::compositor::bitplane::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
