#include "compositor/codecs/bitplane/strip_code.hpp"

#include <array>
#include <bit>
#include <cstring>

#include "common/base/little_endian.hpp"
#include "compositor/codecs/bitplane/word_arithmetic.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/codecs/bitplane/strip_code.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "compositor/codecs/bitplane/pack_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::bitplane::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE // no vectors of known size

size_t encode(const StripSource& source, const StripKind& kind, std::byte* into) {
    return encodeStripScalar(source, kind, into);
}
void decode(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target) {
    decodeStripScalar(strip, kind, target);
}
void finishFirst(const StripTarget& target, Arithmetic a, unsigned leftWords) {
    std::array<uint32_t, kTileColumns> sums{};
    for (unsigned x = 0; x < target.blocks * kBlockColumns; ++x) {
        const uint32_t left = x >= leftWords ? sums[x - leftWords] : 0;
        for (unsigned y = 0; y < kStripRows; ++y) {
            std::byte* at = target.rows + y * target.strideBytes + 4 * x;
            uint32_t word;
            std::memcpy(&word, at, sizeof word);
            const uint32_t sum = add(a, turned(a, word), left);
            if (y == 0) sums[x] = sum;
            word = turnedBack(a, sum);
            std::memcpy(at, &word, sizeof word);
        }
    }
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<uint32_t, kBlockColumns>;
using W = hn::Vec<Words>;
constexpr size_t kLanes = hn::MaxLanes(Words());
constexpr size_t kSteps = kBlockColumns / kLanes;

template <Arithmetic A>
using Lane = std::conditional_t<A == Arithmetic::Bytes, uint8_t,
                                std::conditional_t<A == Arithmetic::Halves, uint16_t, uint32_t>>;

template <Arithmetic A, class V> HWY_INLINE V subtracted(V a, V b) {
    const hn::DFromV<V> words;
    const hn::Repartition<Lane<A>, hn::DFromV<V>> d;
    return hn::BitCast(words, hn::Sub(hn::BitCast(d, a), hn::BitCast(d, b)));
}
template <Arithmetic A, class V> HWY_INLINE V added(V a, V b) {
    const hn::DFromV<V> words;
    const hn::Repartition<Lane<A>, hn::DFromV<V>> d;
    return hn::BitCast(words, hn::Add(hn::BitCast(d, a), hn::BitCast(d, b)));
}
template <Arithmetic A> HWY_INLINE W foldedLanes(W v) {
    const hn::Repartition<std::make_signed_t<Lane<A>>, Words> d;
    const auto s = hn::BitCast(d, v);
    return hn::BitCast(Words(), hn::Xor(hn::Add(s, s), hn::BroadcastSignBit(s)));
}
template <Arithmetic A> HWY_INLINE W unfoldedLanes(W v) {
    using T = Lane<A>;
    const hn::Repartition<T, Words> d;
    const auto sign = hn::Sub(hn::Zero(d), hn::And(hn::BitCast(d, v), hn::Set(d, T{1})));
    if constexpr (sizeof(T) == 1) {
        const hn::Repartition<uint16_t, Words> d16;
        const auto half = hn::And(hn::BitCast(d, hn::ShiftRight<1>(hn::BitCast(d16, v))), hn::Set(d, T{0x7f}));
        return hn::BitCast(Words(), hn::Xor(half, sign));
    } else {
        return hn::BitCast(Words(), hn::Xor(hn::ShiftRight<1>(hn::BitCast(d, v)), sign));
    }
}
template <Arithmetic A> HWY_INLINE W loadTurned(const std::byte* at) {
    const W v = hn::LoadU(Words(), reinterpret_cast<const uint32_t*>(at));
    if constexpr (A == Arithmetic::RotatedWords)
        return hn::RotateRight<8>(v);
    else
        return v;
}
template <Arithmetic A> HWY_INLINE void storeTurnedBack(W v, std::byte* at) {
    if constexpr (A == Arithmetic::RotatedWords)
        hn::StoreU(hn::RotateRight<24>(v), Words(), reinterpret_cast<uint32_t*>(at));
    else
        hn::StoreU(v, Words(), reinterpret_cast<uint32_t*>(at));
}

struct Four {
    W a, b, c, d;
};

// Transposes bytes within each lane: byte i of word j becomes byte j of word i. Self-inverse; converts rows of words to
// channels.
HWY_INLINE Four transposed(const Four& v) {
    const Words w;
    const hn::Repartition<uint16_t, Words> d16;
    const hn::Repartition<uint8_t, Words> d8;
    const auto mix16 = [&](W odd, W even) {
        return hn::BitCast(w, hn::OddEven(hn::BitCast(d16, odd), hn::BitCast(d16, even)));
    };
    const auto mix8 = [&](W odd, W even) {
        return hn::BitCast(w, hn::OddEven(hn::BitCast(d8, odd), hn::BitCast(d8, even)));
    };
    const W t0 = mix16(hn::ShiftLeft<16>(v.c), v.a), t2 = mix16(v.c, hn::ShiftRight<16>(v.a));
    const W t1 = mix16(hn::ShiftLeft<16>(v.d), v.b), t3 = mix16(v.d, hn::ShiftRight<16>(v.b));
    return {mix8(hn::ShiftLeft<8>(t1), t0), mix8(t1, hn::ShiftRight<8>(t0)), mix8(hn::ShiftLeft<8>(t3), t2),
            mix8(t3, hn::ShiftRight<8>(t2))};
}

// Returns the residuals of the four rows.
template <Arithmetic A, Predictor P, bool kFirst> HWY_INLINE Four differences(const StripSource& s, size_t byte) {
    const W above = loadTurned<A>(s.above + byte);
    const W r0 = loadTurned<A>(s.rows + byte), r1 = loadTurned<A>(s.rows + s.strideBytes + byte);
    const W r2 = loadTurned<A>(s.rows + 2 * s.strideBytes + byte),
            r3 = loadTurned<A>(s.rows + 3 * s.strideBytes + byte);
    Four d{subtracted<A>(r0, above), subtracted<A>(r1, r0), subtracted<A>(r2, r1), subtracted<A>(r3, r2)};
    if constexpr (P == Predictor::Slope) {
        d.d = subtracted<A>(d.d, d.c);
        d.c = subtracted<A>(d.c, d.b);
        if constexpr (!kFirst) {
            d.b = subtracted<A>(d.b, d.a);
            d.a = subtracted<A>(d.a, subtracted<A>(above, loadTurned<A>(s.above2 + byte)));
        }
    }
    return d;
}

HWY_INLINE W ored(const Four& f) { return hn::Or(hn::Or(f.a, f.b), hn::Or(f.c, f.d)); }
HWY_INLINE bool isZero(W v) { return hn::AllTrue(Words(), hn::Eq(v, hn::Zero(Words()))); }

template <Arithmetic A> HWY_INLINE Four residuals(Four d) {
    if constexpr (A == Arithmetic::Bytes) {
        Four c = transposed(d);
        c.a = subtracted<A>(c.a, c.b);
        c.c = subtracted<A>(c.c, c.b);
        return {foldedLanes<A>(c.a), foldedLanes<A>(c.b), foldedLanes<A>(c.c), foldedLanes<A>(c.d)};
    } else {
        return transposed({foldedLanes<A>(d.a), foldedLanes<A>(d.b), foldedLanes<A>(d.c), foldedLanes<A>(d.d)});
    }
}

using Quad = hn::Full128<uint32_t>;
template <class V> HWY_INLINE hn::Vec<Quad> foldedToQuad(V v) {
    if constexpr (kLanes == 16) {
        const hn::Half<Words> half;
        const auto h = hn::Or(hn::LowerHalf(half, v), hn::UpperHalf(half, v));
        return hn::Or(hn::LowerHalf(Quad(), h), hn::UpperHalf(Quad(), h));
    } else if constexpr (kLanes == 8) {
        return hn::Or(hn::LowerHalf(Quad(), v), hn::UpperHalf(Quad(), v));
    } else {
        return v;
    }
}

// Returns the widths of the four channels from the bitwise OR of their bytes.
HWY_INLINE uint16_t widthsOf(const Four& channels) {
    const Quad d;
    const hn::Full128<uint64_t> d64;
    const auto a = foldedToQuad(channels.a), b = foldedToQuad(channels.b), c = foldedToQuad(channels.c),
               e = foldedToQuad(channels.d);
    const auto ab = hn::BitCast(d64, hn::Or(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b)));
    const auto ce = hn::BitCast(d64, hn::Or(hn::InterleaveLower(d, c, e), hn::InterleaveUpper(d, c, e)));
    auto v = hn::BitCast(d, hn::Or(hn::InterleaveLower(d64, ab, ce), hn::InterleaveUpper(d64, ab, ce)));
    v = hn::Or(v, hn::ShiftRight<16>(v));
    v = hn::And(hn::Or(v, hn::ShiftRight<8>(v)), hn::Set(d, 0xff));
    // The exponent of a float gives the number of bits; that of zero saturates to 0.
    const hn::Full128<int32_t> di;
    const hn::Full128<float> df;
    const auto exponent = hn::ShiftRight<23>(hn::BitCast(di, hn::ConvertTo(df, hn::BitCast(di, v))));
    const auto width = hn::Max(hn::Sub(exponent, hn::Set(di, 126)), hn::Zero(di));
    alignas(16) int32_t w[4];
    hn::Store(width, di, w);
    return static_cast<uint16_t>(w[0] | w[1] << 4 | w[2] << 8 | w[3] << 12);
}

template <Arithmetic A, Predictor P, bool kFirst> size_t encodeAs(const StripSource& source, std::byte* into) {
    alignas(64) uint8_t channels[kMaxBlocks * kBlockBytes]; // of the non-zero blocks
    uint16_t widths[kMaxBlocks];
    uint32_t present = 0;
    unsigned count = 0;
    for (unsigned block = 0; block < source.blocks; ++block) {
        const size_t from = block * kBlockColumns * 4;
        Four d[kSteps];
        W any = hn::Zero(Words());
#pragma GCC unroll 4 // without it GCC at -O2 keeps the loop's values in memory
        for (size_t s = 0; s < kSteps; ++s) {
            d[s] = differences<A, P, kFirst>(source, from + s * kLanes * 4);
            any = hn::Or(any, ored(d[s]));
        }
        if (isZero(any)) continue; // the majority in many pictures
        Four sum{hn::Zero(Words()), hn::Zero(Words()), hn::Zero(Words()), hn::Zero(Words())};
        uint8_t* to = channels + count * kBlockBytes;
#pragma GCC unroll 4
        for (size_t s = 0; s < kSteps; ++s) {
            const Four r = residuals<A>(d[s]);
            const auto keep = [&](W v, unsigned channel) {
                hn::Store(v, Words(), reinterpret_cast<uint32_t*>(to + channel * kChannelBytes + s * kLanes * 4));
            };
            keep(r.a, 0);
            keep(r.b, 1);
            keep(r.c, 2);
            keep(r.d, 3);
            sum = {hn::Or(sum.a, r.a), hn::Or(sum.b, r.b), hn::Or(sum.c, r.c), hn::Or(sum.d, r.d)};
        }
        present |= 1u << block;
        widths[count++] = widthsOf(sum);
    }
    storeLittle(into, static_cast<uint16_t>(present));
    auto* out = reinterpret_cast<uint8_t*>(into) + kStripHeadBytes;
    for (unsigned i = 0; i < count; ++i, out += 2) storeLittle(reinterpret_cast<std::byte*>(out), widths[i]);
    for (unsigned i = 0; i < count; ++i)
#pragma GCC unroll 4
        for (unsigned c = 0; c < 4; ++c)
            if (const unsigned width = widths[i] >> (4 * c) & 15)
                out = packChannel(channels + i * kBlockBytes + c * kChannelBytes, width, out);
    return static_cast<size_t>(out - reinterpret_cast<uint8_t*>(into));
}

template <Arithmetic A, Predictor P, bool kFirst>
HWY_INLINE void rebuild(const StripTarget& t, size_t byte, const Four& difference) {
    const W above = loadTurned<A>(t.above + byte);
    Four d = difference;
    if constexpr (P == Predictor::Slope) {
        if constexpr (!kFirst) {
            d.a = added<A>(d.a, subtracted<A>(above, loadTurned<A>(t.above2 + byte)));
            d.b = added<A>(d.b, d.a);
        }
        d.c = added<A>(d.c, d.b);
        d.d = added<A>(d.d, d.c);
    }
    const W r0 = added<A>(above, d.a), r1 = added<A>(r0, d.b), r2 = added<A>(r1, d.c), r3 = added<A>(r2, d.d);
    storeTurnedBack<A>(r0, t.rows + byte);
    storeTurnedBack<A>(r1, t.rows + t.strideBytes + byte);
    storeTurnedBack<A>(r2, t.rows + 2 * t.strideBytes + byte);
    storeTurnedBack<A>(r3, t.rows + 3 * t.strideBytes + byte);
}

template <Arithmetic A> HWY_INLINE Four differencesOf(const Four& r) {
    if constexpr (A == Arithmetic::Bytes) {
        Four c{unfoldedLanes<A>(r.a), unfoldedLanes<A>(r.b), unfoldedLanes<A>(r.c), unfoldedLanes<A>(r.d)};
        c.a = added<A>(c.a, c.b);
        c.c = added<A>(c.c, c.b);
        return transposed(c);
    } else {
        const Four d = transposed(r);
        return {unfoldedLanes<A>(d.a), unfoldedLanes<A>(d.b), unfoldedLanes<A>(d.c), unfoldedLanes<A>(d.d)};
    }
}

template <Arithmetic A, Predictor P, bool kFirst>
HWY_INLINE void rebuildUnchanged(const StripTarget& target, size_t to) {
    const W zero = hn::Zero(Words());
    for (size_t s = 0; s < kSteps; ++s) rebuild<A, P, kFirst>(target, to + s * kLanes * 4, {zero, zero, zero, zero});
}

#if HWY_MAX_BYTES >= 32

template <class D> HWY_INLINE hn::Vec<D> wordsOf(D words, const Channel& channel, size_t step) {
    if constexpr (hn::MaxLanes(D()) == 16)
        return hn::BitCast(words, hn::Combine(hn::Repartition<uint8_t, D>(), channel.high, channel.low));
    else
        return hn::BitCast(words, step == 0 ? channel.low : channel.high);
}

template <Arithmetic A, Predictor P, bool kFirst, size_t kStep>
HWY_INLINE void rebuildStep(const StripTarget& t, size_t to, const Channel& a, const Channel& b, const Channel& c,
                            const Channel& e) {
    const Words w;
    rebuild<A, P, kFirst>(
        t, to + kStep * kLanes * 4,
        differencesOf<A>({wordsOf(w, a, kStep), wordsOf(w, b, kStep), wordsOf(w, c, kStep), wordsOf(w, e, kStep)}));
}

// Keeps the channels of a block in registers.
template <Arithmetic A, Predictor P, bool kFirst> void decodeAs(const ParsedStrip& strip, const StripTarget& given) {
    const StripTarget target = given; // a copy, because stores to pixels might alias it
    const auto* from = reinterpret_cast<const uint8_t*>(strip.payload);
    const uint16_t* widths = strip.widths.data();
    for (unsigned block = 0, present = strip.present; block < target.blocks; ++block, present >>= 1) {
        const size_t to = block * kBlockColumns * 4;
        if ((present & 1) == 0) {
            rebuildUnchanged<A, P, kFirst>(target, to);
            continue;
        }
        const unsigned w = *widths++;
        const Channel a = unpackChannel(from, w & 15), b = unpackChannel(from, w >> 4 & 15),
                      c = unpackChannel(from, w >> 8 & 15);
        // zero in opaque pictures
        const Channel e = w >> 12 ? unpackChannel(from, w >> 12) : Channel{hn::Zero(Bytes32()), hn::Zero(Bytes32())};
        rebuildStep<A, P, kFirst, 0>(target, to, a, b, c, e);
        if constexpr (kSteps == 2) rebuildStep<A, P, kFirst, 1>(target, to, a, b, c, e);
    }
}

#else

template <Arithmetic A, Predictor P, bool kFirst> void decodeAs(const ParsedStrip& strip, const StripTarget& given) {
    const StripTarget target = given;
    alignas(64) uint8_t channels[kMaxBlocks * kBlockBytes];
    const auto* from = reinterpret_cast<const uint8_t*>(strip.payload);
    const auto count = static_cast<unsigned>(std::popcount(strip.present));
    for (unsigned i = 0; i < count; ++i)
        for (unsigned c = 0; c < 4; ++c) {
            uint8_t* to = channels + i * kBlockBytes + c * kChannelBytes;
            if (const unsigned width = strip.widths[i] >> (4 * c) & 15)
                from = unpackChannel(from, width, to);
            else
                std::memset(to, 0, kChannelBytes);
        }
    const uint8_t* next = channels;
    for (unsigned block = 0; block < target.blocks; ++block) {
        const size_t to = block * kBlockColumns * 4;
        if ((strip.present >> block & 1) == 0) {
            rebuildUnchanged<A, P, kFirst>(target, to);
            continue;
        }
        for (size_t s = 0; s < kSteps; ++s) {
            const auto channel = [&](unsigned c) {
                return hn::Load(Words(), reinterpret_cast<const uint32_t*>(next + c * kChannelBytes + s * kLanes * 4));
            };
            rebuild<A, P, kFirst>(target, to + s * kLanes * 4,
                                  differencesOf<A>({channel(0), channel(1), channel(2), channel(3)}));
        }
        next += kBlockBytes;
    }
}

#endif

template <class Do> auto withKind(const StripKind& kind, Do&& each) {
    const auto withPredictor = [&]<Arithmetic A>() {
        if (kind.predictor == Predictor::Slope)
            return kind.first ? each.template operator()<A, Predictor::Slope, true>()
                              : each.template operator()<A, Predictor::Slope, false>();
        return kind.first ? each.template operator()<A, Predictor::Above, true>()
                          : each.template operator()<A, Predictor::Above, false>();
    };
    switch (kind.arithmetic) {
    case Arithmetic::Bytes: return withPredictor.template operator()<Arithmetic::Bytes>();
    case Arithmetic::Halves: return withPredictor.template operator()<Arithmetic::Halves>();
    case Arithmetic::RotatedWords: return withPredictor.template operator()<Arithmetic::RotatedWords>();
    case Arithmetic::Words: break;
    }
    return withPredictor.template operator()<Arithmetic::Words>();
}

size_t encode(const StripSource& source, const StripKind& kind, std::byte* into) {
    return withKind(kind,
                    [&]<Arithmetic A, Predictor P, bool kFirst>() { return encodeAs<A, P, kFirst>(source, into); });
}

void decode(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target) {
    withKind(kind, [&]<Arithmetic A, Predictor P, bool kFirst>() { decodeAs<A, P, kFirst>(strip, target); });
}

// Prefix sum, four words at a time.
template <Arithmetic A> void finishAs(const StripTarget& target, unsigned leftWords) {
    const Quad d;
    const hn::Full128<uint64_t> d64;
    alignas(64) uint32_t changes[kTileColumns];
    const unsigned columns = target.blocks * kBlockColumns;
    auto before = hn::Zero(d);
    for (unsigned x = 0; x < columns; x += 4) {
        auto v = hn::LoadU(d, reinterpret_cast<const uint32_t*>(target.rows + 4 * x));
        if constexpr (A == Arithmetic::RotatedWords) v = hn::RotateRight<8>(v);
        auto sum = v;
        if (leftWords == 1) sum = added<A>(sum, hn::ShiftLeftBytes<4>(d, sum));
        if (leftWords <= 2) sum = added<A>(sum, hn::ShiftLeftBytes<8>(d, sum));
        sum = added<A>(sum, before);
        hn::Store(subtracted<A>(sum, v), d, changes + x);
        before = leftWords == 4
                     ? sum
                     : hn::BitCast(d, hn::InterleaveUpper(d64, hn::BitCast(d64, sum), hn::BitCast(d64, sum)));
        if (leftWords == 1) before = hn::Broadcast<3>(sum);
    }
    for (unsigned y = 0; y < kStripRows; ++y)
        for (unsigned x = 0; x < columns; x += kLanes) {
            std::byte* at = target.rows + y * target.strideBytes + 4 * x;
            storeTurnedBack<A>(added<A>(loadTurned<A>(at), hn::Load(Words(), changes + x)), at);
        }
}

void finishFirst(const StripTarget& target, Arithmetic a, unsigned leftWords) {
    if (a == Arithmetic::Bytes)
        finishAs<Arithmetic::Bytes>(target, leftWords);
    else if (a == Arithmetic::Halves)
        finishAs<Arithmetic::Halves>(target, leftWords);
    else if (a == Arithmetic::Words)
        finishAs<Arithmetic::Words>(target, leftWords);
    else
        finishAs<Arithmetic::RotatedWords>(target, leftWords);
}

#endif

} // namespace mural::compositor::bitplane::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor::bitplane {

HWY_EXPORT(encode);
HWY_EXPORT(decode);
HWY_EXPORT(finishFirst);

size_t encodeStrip(const StripSource& source, const StripKind& kind, std::byte* into) {
    return HWY_DYNAMIC_DISPATCH(encode)(source, kind, into);
}
void decodeStrip(const ParsedStrip& strip, const StripKind& kind, const StripTarget& target) {
    HWY_DYNAMIC_DISPATCH(decode)(strip, kind, target);
}

void finishFirstStrip(const StripTarget& target, Arithmetic arithmetic, unsigned leftWords) {
    HWY_DYNAMIC_DISPATCH(finishFirst)(target, arithmetic, leftWords);
}

} // namespace mural::compositor::bitplane
#endif
