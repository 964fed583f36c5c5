#include "compositor/kernels/blend_over.hpp"

#include <cstdint>

#include "compositor/kernels/prefetch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/blend_over.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // no vectors: the scalar loop does everything

size_t blendRgba8(uint32_t*, const uint32_t*, size_t, bool) { return 0; }
size_t blendRgb10A2(uint32_t*, const uint32_t*, size_t, bool) { return 0; }
size_t blendHalves(uint16_t*, const uint16_t*, size_t, bool) { return 0; }
size_t blendFloats(float*, const float*, size_t, bool) { return 0; }

#else

namespace hn = hwy::HWY_NAMESPACE;

// Even and odd bytes as 16-bit lanes, which hold a product of two bytes. Rounded x / 255 equals (x + 128 + (x + 128) /
// 256) / 256 for all products.
template <class D> hn::Vec<D> over8(D d32, hn::Vec<D> front, hn::Vec<D> back) {
    const hn::Repartition<uint16_t, D> d16;
    const hn::Repartition<uint8_t, D> d8;
    const auto evenMask = hn::Set(d16, 0x00ff);
    const auto half = hn::Set(d16, 128);
    const auto alpha = hn::ShiftRight<24>(front);
    const auto left = hn::Xor(hn::BitCast(d16, hn::Or(alpha, hn::ShiftLeft<16>(alpha))), evenMask); // 255 - alpha
    const auto b = hn::BitCast(d16, back);
    auto even = hn::Add(hn::Mul(hn::And(b, evenMask), left), half);
    auto odd = hn::Add(hn::Mul(hn::ShiftRight<8>(b), left), half);
    even = hn::ShiftRight<8>(hn::Add(even, hn::ShiftRight<8>(even)));
    odd = hn::AndNot(evenMask, hn::Add(odd, hn::ShiftRight<8>(odd)));
    const auto covered = hn::BitCast(d8, hn::Or(even, odd));
    return hn::BitCast(d32, hn::SaturatedAdd(hn::BitCast(d8, front), covered));
}

// Rounded x / 3 equals (x + 1) * 43691 / 2^17 for all x below 98304.
template <class D> hn::Vec<D> thirds(D d, hn::Vec<D> x) {
    return hn::ShiftRight<17>(hn::Mul(hn::Add(x, hn::Set(d, 1)), hn::Set(d, 43691)));
}

template <class D> hn::Vec<D> over10(D d, hn::Vec<D> front, hn::Vec<D> back) {
    const auto maximum = hn::Set(d, 1023);
    const auto alpha = hn::ShiftRight<30>(front);
    const auto left = hn::Sub(hn::Set(d, 3), alpha);
    const auto red =
        hn::Min(hn::Add(hn::And(front, maximum), thirds(d, hn::Mul(hn::And(back, maximum), left))), maximum);
    const auto green = hn::Min(hn::Add(hn::And(hn::ShiftRight<10>(front), maximum),
                                       thirds(d, hn::Mul(hn::And(hn::ShiftRight<10>(back), maximum), left))),
                               maximum);
    const auto blue = hn::Min(hn::Add(hn::And(hn::ShiftRight<20>(front), maximum),
                                      thirds(d, hn::Mul(hn::And(hn::ShiftRight<20>(back), maximum), left))),
                              maximum);
    const auto cover = hn::Min(hn::Add(alpha, thirds(d, hn::Mul(hn::ShiftRight<30>(back), left))), hn::Set(d, 3));
    return hn::Or(hn::Or(red, hn::ShiftLeft<10>(green)), hn::Or(hn::ShiftLeft<20>(blue), hn::ShiftLeft<30>(cover)));
}

constexpr size_t kAheadWords = 256; // prefetch distance

// Skips vectors without effect, because most of a picture is empty. Two vectors per step, since a cache line is one
// vector only with the widest of them.
template <bool kTen> size_t blendWords(uint32_t* pixels, const uint32_t* source, size_t count, bool inFront) {
    const hn::ScalableTag<uint32_t> d;
    const size_t lanes = hn::Lanes(d), step = 2 * lanes;
    const auto zero = hn::Zero(d);
    const auto blended = [&](hn::Vec<decltype(d)> s, hn::Vec<decltype(d)> p) {
        const auto front = inFront ? s : p;
        const auto back = inFront ? p : s;
        return kTen ? over10(d, front, back) : over8(d, front, back);
    };
    size_t i = 0;
    for (; i + step <= count; i += step) {
        prefetch(source + i + kAheadWords, 4 * step);
        prefetch(pixels + i + kAheadWords, 4 * step);
        const auto first = hn::LoadU(d, source + i), second = hn::LoadU(d, source + i + lanes);
        if (hn::AllTrue(d, hn::Eq(hn::Or(first, second), zero))) continue;
        hn::StoreU(blended(first, hn::LoadU(d, pixels + i)), d, pixels + i);
        hn::StoreU(blended(second, hn::LoadU(d, pixels + i + lanes)), d, pixels + i + lanes);
    }
    for (; i + lanes <= count; i += lanes)
        hn::StoreU(blended(hn::LoadU(d, source + i), hn::LoadU(d, pixels + i)), d, pixels + i);
    return i;
}

size_t blendRgba8(uint32_t* pixels, const uint32_t* source, size_t count, bool inFront) {
    return blendWords<false>(pixels, source, count, inFront);
}
size_t blendRgb10A2(uint32_t* pixels, const uint32_t* source, size_t count, bool inFront) {
    return blendWords<true>(pixels, source, count, inFront);
}

// Whole pixels only: vectors of 4 or more floats.
size_t blendFloats(float* pixels, const float* source, size_t count, bool inFront) {
    const hn::ScalableTag<float> d;
    const size_t step = hn::Lanes(d) / 4;
    size_t i = 0;
    const auto one = hn::Set(d, 1.0f);
    for (; i + step <= count; i += step) {
        const auto s = hn::LoadU(d, source + 4 * i);
        const auto p = hn::LoadU(d, pixels + 4 * i);
        const auto front = inFront ? s : p;
        const auto left = hn::Sub(one, hn::Broadcast<3>(front)); // per 128-bit block
        const auto covered = hn::Mul(inFront ? p : s, left);
        hn::StoreU(hn::Add(front, covered), d, pixels + 4 * i);
    }
    return i;
}

// As in half_float.hpp.
template <class D> hn::Vec<hn::RebindToFloat<D>> floatsOfHalves(D d, hn::Vec<D> half) {
    const hn::RebindToFloat<D> df;
    const auto sign = hn::ShiftLeft<16>(hn::And(half, hn::Set(d, 0x8000)));
    const auto rest = hn::ShiftLeft<13>(hn::And(half, hn::Set(d, 0x7fff)));
    const auto exponent = hn::And(rest, hn::Set(d, 0x7c00u << 13));
    const auto special = hn::Eq(exponent, hn::Set(d, 0x7c00u << 13));
    const auto denormal = hn::Eq(exponent, hn::Zero(d));
    const auto scale = hn::Set(d, 113u << 23);
    const auto small = hn::BitCast(d, hn::Sub(hn::BitCast(df, hn::Add(rest, scale)), hn::BitCast(df, scale)));
    const auto usual =
        hn::Add(rest, hn::IfThenElse(special, hn::Set(d, (255u - 31u) << 23), hn::Set(d, (127u - 15u) << 23)));
    return hn::BitCast(df, hn::Or(sign, hn::IfThenElse(denormal, small, usual)));
}

template <class D> hn::Vec<D> halvesOfFloats(D d, hn::Vec<hn::RebindToFloat<D>> value) {
    const hn::RebindToFloat<D> df;
    const hn::RebindToSigned<D> di; // without the sign all values are positive
    const auto bits = hn::BitCast(d, value);
    const auto sign = hn::And(hn::ShiftRight<16>(bits), hn::Set(d, 0x8000));
    const auto rest = hn::And(bits, hn::Set(d, 0x7fffffff));
    const auto above = [&](uint32_t limit) {
        return hn::RebindMask(d, hn::Gt(hn::BitCast(di, rest), hn::Set(di, static_cast<int32_t>(limit))));
    };
    const auto small =
        hn::Sub(hn::BitCast(d, hn::Add(hn::BitCast(df, rest), hn::Set(df, 0.5f))), hn::Set(d, 0x3f000000u));
    const auto odd = hn::And(hn::ShiftRight<13>(rest), hn::Set(d, 1));
    const auto usual = hn::ShiftRight<13>(hn::Add(hn::Sub(rest, hn::Set(d, ((127u - 15u) << 23) - 0xfff)), odd));
    auto result = hn::IfThenElse(above((113u << 23) - 1), usual, small);
    result = hn::IfThenElse(above(((127u + 16u) << 23) - 1), hn::Set(d, 0x7c00), result);
    return hn::IfThenElse(above(0x7f800000), hn::Set(d, 0x7e00), hn::Or(sign, result));
}

size_t blendHalves(uint16_t* pixels, const uint16_t* source, size_t count, bool inFront) {
    const hn::ScalableTag<uint32_t> d;
    const size_t step = hn::Lanes(d) / 4;
    size_t i = 0;
    const hn::Rebind<uint16_t, decltype(d)> d16;
    const hn::RebindToFloat<decltype(d)> df;
    const hn::RebindToSigned<decltype(d)> di;
    const auto one = hn::Set(df, 1.0f);
    for (; i + step <= count; i += step) {
        const auto s = floatsOfHalves(d, hn::PromoteTo(d, hn::LoadU(d16, source + 4 * i)));
        const auto p = floatsOfHalves(d, hn::PromoteTo(d, hn::LoadU(d16, pixels + 4 * i)));
        const auto front = inFront ? s : p;
        const auto covered = hn::Mul(inFront ? p : s, hn::Sub(one, hn::Broadcast<3>(front)));
        const auto halves = halvesOfFloats(d, hn::Add(front, covered));
        hn::StoreU(hn::DemoteTo(d16, hn::BitCast(di, halves)), d16, pixels + 4 * i);
    }
    return i;
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(blendRgba8);
HWY_EXPORT(blendRgb10A2);
HWY_EXPORT(blendHalves);
HWY_EXPORT(blendFloats);

void blendOverRow(PlaneFormat format, std::byte* pixels, const std::byte* source, size_t count, SourceSide side) {
    const bool inFront = side == SourceSide::InFront;
    const auto words = [&] { return reinterpret_cast<uint32_t*>(pixels); };
    const auto sourceWords = [&] { return reinterpret_cast<const uint32_t*>(source); };
    size_t done = 0;
    switch (format) {
    case PlaneFormat::Rgba8: done = HWY_DYNAMIC_DISPATCH(blendRgba8)(words(), sourceWords(), count, inFront); break;
    case PlaneFormat::Rgb10A2: done = HWY_DYNAMIC_DISPATCH(blendRgb10A2)(words(), sourceWords(), count, inFront); break;
    case PlaneFormat::Rgba16F:
        done = HWY_DYNAMIC_DISPATCH(blendHalves)(reinterpret_cast<uint16_t*>(pixels),
                                                 reinterpret_cast<const uint16_t*>(source), count, inFront);
        break;
    case PlaneFormat::Rgba32F:
        done = HWY_DYNAMIC_DISPATCH(blendFloats)(reinterpret_cast<float*>(pixels),
                                                 reinterpret_cast<const float*>(source), count, inFront);
        break;
    case PlaneFormat::D24S8:
    case PlaneFormat::D32F: return; // depth planes are not blended
    }
    const size_t skip = done * bytesPerPixel(format);
    blendOverRowScalar(format, pixels + skip, source + skip, count - done, side);
}

} // namespace mural::compositor
#endif
