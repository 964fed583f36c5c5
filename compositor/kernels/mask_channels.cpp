#include "compositor/kernels/mask_channels.hpp"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/mask_channels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // no vectors: the scalar loop does everything

size_t maskVectors(uint8_t*, const uint8_t*, size_t, const uint8_t*) { return 0; }

#else

namespace hn = hwy::HWY_NAMESPACE;

size_t maskVectors(uint8_t* into, const uint8_t* source, size_t sizeBytes, const uint8_t* mask) {
    size_t i = 0;
    const hn::ScalableTag<uint8_t> d;
    const size_t step = hn::Lanes(d);
    const auto taken = hn::LoadDup128(d, mask);
    for (; i + step <= sizeBytes; i += step) {
        const auto retained = hn::AndNot(taken, hn::LoadU(d, into + i));
        hn::StoreU(hn::Or(retained, hn::And(taken, hn::LoadU(d, source + i))), d, into + i);
    }
    return i;
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(maskVectors);

void maskChannelsRowScalar(std::byte* into, const std::byte* source, size_t sizeBytes, const ChannelMask& mask) {
    for (size_t i = 0; i < sizeBytes; ++i)
        into[i] = (into[i] & ~mask[i % mask.size()]) | (source[i] & mask[i % mask.size()]);
}

void maskChannelsRow(std::byte* into, const std::byte* source, size_t sizeBytes, const ChannelMask& mask) {
    alignas(16) ChannelMask aligned = mask;
    const size_t done =
        HWY_DYNAMIC_DISPATCH(maskVectors)(reinterpret_cast<uint8_t*>(into), reinterpret_cast<const uint8_t*>(source),
                                          sizeBytes, reinterpret_cast<const uint8_t*>(aligned.data()));
    maskChannelsRowScalar(into + done, source + done, sizeBytes - done, mask); // a vector is a whole number of masks
}

} // namespace mural::compositor
#endif
