#include "transport/rsp/erasure/gf256.hpp"

// Highway compiles the code between BEFORE and AFTER once per instruction set and selects at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/rsp/erasure/gf256.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::rsp::gf256::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Multiplication by a constant is linear in the bits: two tables of 16 give the products of the low and the high
// nibble.
void multiplyAdd(uint8_t* HWY_RESTRICT into, const uint8_t* HWY_RESTRICT from, size_t count, uint8_t factor) {
    alignas(16) uint8_t low[16];
    alignas(16) uint8_t high[16];
    for (unsigned i = 0; i < 16; ++i) {
        low[i] = gf256::multiply(static_cast<uint8_t>(i), factor);
        high[i] = gf256::multiply(static_cast<uint8_t>(i << 4), factor);
    }
    size_t i = 0;
#if HWY_TARGET != HWY_SCALAR // the scalar target has no table lookup
    const hn::ScalableTag<uint8_t> d;
    const auto lows = hn::LoadDup128(d, low);
    const auto highs = hn::LoadDup128(d, high);
    const auto mask = hn::Set(d, 0x0f);
    const size_t step = hn::Lanes(d);
    for (; i + step <= count; i += step) {
        const auto v = hn::LoadU(d, from + i);
        const auto lowHalf = hn::And(v, mask);
        const auto highHalf = hn::ShiftRight<4>(v);
        const auto product = hn::Xor(hn::TableLookupBytes(lows, lowHalf), hn::TableLookupBytes(highs, highHalf));
        hn::StoreU(hn::Xor(product, hn::LoadU(d, into + i)), d, into + i);
    }
#endif
    for (; i < count; ++i) into[i] ^= static_cast<uint8_t>(low[from[i] & 15] ^ high[from[i] >> 4]);
}

void add(uint8_t* HWY_RESTRICT into, const uint8_t* HWY_RESTRICT from, size_t count) {
    const hn::ScalableTag<uint8_t> d;
    const size_t step = hn::Lanes(d);
    size_t i = 0;
    for (; i + step <= count; i += step)
        hn::StoreU(hn::Xor(hn::LoadU(d, from + i), hn::LoadU(d, into + i)), d, into + i);
    for (; i < count; ++i) into[i] ^= from[i];
}

} // namespace mural::rsp::gf256::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::rsp::gf256 {

HWY_EXPORT(multiplyAdd);
HWY_EXPORT(add);

void multiplyAdd(std::span<std::byte> into, std::span<const std::byte> from, uint8_t factor) {
    auto* to = reinterpret_cast<uint8_t*>(into.data());
    const auto* source = reinterpret_cast<const uint8_t*>(from.data());
    if (factor == 0) return;
    if (factor == 1) return HWY_DYNAMIC_DISPATCH(add)(to, source, from.size());
    HWY_DYNAMIC_DISPATCH(multiplyAdd)(to, source, from.size(), factor);
}

void multiplyAddScalar(std::span<std::byte> into, std::span<const std::byte> from, uint8_t factor) {
    for (size_t i = 0; i < from.size(); ++i)
        into[i] ^= static_cast<std::byte>(multiply(std::to_integer<uint8_t>(from[i]), factor));
}

} // namespace mural::rsp::gf256
#endif
