#include "compositor/kernels/average_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/average_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // no vectors: the scalar loop does everything

size_t addVectors(uint16_t*, const uint8_t*, size_t) { return 0; }
size_t average16(uint8_t*, const uint16_t*, size_t, uint32_t) { return 0; }
size_t average32(uint8_t*, const uint32_t*, size_t, uint32_t) { return 0; }

#else

namespace hn = hwy::HWY_NAMESPACE;

size_t addVectors(uint16_t* sums, const uint8_t* components, size_t count) {
    const hn::ScalableTag<uint16_t> d;
    const hn::Rebind<uint8_t, decltype(d)> d8;
    const size_t step = hn::Lanes(d);
    size_t i = 0;
    for (; i + step <= count; i += step)
        hn::StoreU(hn::Add(hn::LoadU(d, sums + i), hn::PromoteTo(d, hn::LoadU(d8, components + i))), d, sums + i);
    return i;
}

// Exact: a fractional quotient is at least 1/n away from an integer, far more than the error of a float division.
template <class D> auto divided(D di, hn::Vec<D> sum, float halfN, float n) {
    const hn::RebindToFloat<D> df;
    return hn::ConvertTo(di, hn::Div(hn::Add(hn::ConvertTo(df, sum), hn::Set(df, halfN)), hn::Set(df, n)));
}

template <class T> size_t averageVectors(uint8_t* components, const T* sums, size_t count, uint32_t n) {
    const hn::ScalableTag<int32_t> di;
    const hn::Rebind<uint8_t, decltype(di)> d8;
    const hn::Rebind<T, decltype(di)> dt;
    const size_t step = hn::Lanes(di);
    const auto halfN = static_cast<float>(n / 2);
    size_t i = 0;
    for (; i + step <= count; i += step) {
        const auto loaded = hn::LoadU(dt, sums + i);
        if constexpr (sizeof(T) == 2)
            hn::StoreU(hn::DemoteTo(d8, divided(di, hn::PromoteTo(di, loaded), halfN, static_cast<float>(n))), d8,
                       components + i);
        else
            hn::StoreU(hn::DemoteTo(d8, divided(di, hn::BitCast(di, loaded), halfN, static_cast<float>(n))), d8,
                       components + i);
    }
    return i;
}

size_t average16(uint8_t* components, const uint16_t* sums, size_t count, uint32_t n) {
    return averageVectors(components, sums, count, n);
}
size_t average32(uint8_t* components, const uint32_t* sums, size_t count, uint32_t n) {
    return averageVectors(components, sums, count, n);
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(addVectors);
HWY_EXPORT(average16);
HWY_EXPORT(average32);

namespace {

template <class T> void averageEach(uint8_t* components, const T* sums, size_t count, uint32_t n) {
    for (size_t i = 0; i < count; ++i) components[i] = static_cast<uint8_t>((uint32_t{sums[i]} + n / 2) / n);
}

} // namespace

void addToSumsScalar(uint16_t* sums, const uint8_t* components, size_t count) {
    for (size_t i = 0; i < count; ++i) sums[i] = static_cast<uint16_t>(sums[i] + components[i]);
}

void averageOfSumsScalar(uint8_t* components, const uint16_t* sums, size_t count, uint32_t n) {
    averageEach(components, sums, count, n);
}
void averageOfSumsScalar(uint8_t* components, const uint32_t* sums, size_t count, uint32_t n) {
    averageEach(components, sums, count, n);
}

void addToSums(uint16_t* sums, const uint8_t* components, size_t count) {
    const size_t done = HWY_DYNAMIC_DISPATCH(addVectors)(sums, components, count);
    addToSumsScalar(sums + done, components + done, count - done);
}

void averageOfSums(uint8_t* components, const uint16_t* sums, size_t count, uint32_t n) {
    const size_t done = HWY_DYNAMIC_DISPATCH(average16)(components, sums, count, n);
    averageEach(components + done, sums + done, count - done, n);
}

void averageOfSums(uint8_t* components, const uint32_t* sums, size_t count, uint32_t n) {
    const size_t done = HWY_DYNAMIC_DISPATCH(average32)(components, sums, count, n);
    averageEach(components + done, sums + done, count - done, n);
}

} // namespace mural::compositor
#endif
