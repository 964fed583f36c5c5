#include "compositor/kernels/find_first_difference.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/find_first_difference.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // no vectors: the scalar loop does everything

size_t findVector(const uint32_t*, size_t, const uint32_t*, const uint32_t*) { return 0; }

#else

namespace hn = hwy::HWY_NAMESPACE;

// Returns the first word of the first differing vector, or of the remainder.
size_t findVector(const uint32_t* words, size_t count, const uint32_t* pattern, const uint32_t* mask) {
    size_t i = 0;
    const hn::ScalableTag<uint32_t> d;
    const size_t step = hn::Lanes(d);
    const auto wanted = hn::LoadDup128(d, pattern);
    const auto mask128 = hn::LoadDup128(d, mask);
    for (; i + step <= count; i += step) {
        const auto unlike = hn::And(hn::Xor(hn::LoadU(d, words + i), wanted), mask128);
        if (!hn::AllTrue(d, hn::Eq(unlike, hn::Zero(d)))) break;
    }
    return i;
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(findVector);

size_t findUnlikeScalar(const uint32_t* words, size_t count, const uint32_t pattern[4], const uint32_t mask[4]) {
    for (size_t i = 0; i < count; ++i)
        if (((words[i] ^ pattern[i % 4]) & mask[i % 4]) != 0) return i;
    return count;
}

size_t findFirstDifference(const uint32_t* words, size_t count, const uint32_t pattern[4], const uint32_t mask[4]) {
    alignas(16) uint32_t p[4], m[4];
    std::memcpy(p, pattern, sizeof p);
    std::memcpy(m, mask, sizeof m);
    const size_t at = HWY_DYNAMIC_DISPATCH(findVector)(words, count, p, m);
    return at + findUnlikeScalar(words + at, count - at, p, m); // `at` is a multiple of 4
}

} // namespace mural::compositor
#endif
