#include "streamcodec/delta/entropy/changed_words.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "streamcodec/delta/entropy/changed_words.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::delta::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

uint64_t changedWordsVectors(const uint8_t* old, const uint8_t* now) {
    const hn::CappedTag<uint32_t, 16> words;
    const auto at = [&](const uint8_t* bytes, size_t word) {
        return hn::LoadU(words, reinterpret_cast<const uint32_t*>(bytes) + word);
    };
    uint64_t bits = 0;
    for (size_t i = 0; i < kComparedWords; i += hn::Lanes(words)) {
        uint8_t differ[8] = {};
        hn::StoreMaskBits(words, hn::Ne(at(old, i), at(now, i)), differ);
        uint32_t some = 0;
        std::memcpy(&some, differ, sizeof some);
        bits |= uint64_t{some} << i;
    }
    return bits;
}

} // namespace mural::delta::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::delta {

HWY_EXPORT(changedWordsVectors);

uint64_t changedWords(const std::byte* old, const std::byte* now) {
    return HWY_DYNAMIC_DISPATCH(changedWordsVectors)(reinterpret_cast<const uint8_t*>(old),
                                                     reinterpret_cast<const uint8_t*>(now));
}

} // namespace mural::delta
#endif
