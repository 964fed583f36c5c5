#include "nodes/shaders/spirv_module.hpp"

#include <cstdint>
#include <cstring>

namespace mural::shaders {

namespace {

constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5;
constexpr uint32_t kDecorate = 71, kMemberDecorate = 72, kBuiltIn = 11, kFragCoord = 15;

} // namespace

bool moduleReadsFragCoord(std::span<const std::byte> module) {
    const size_t words = module.size() / 4;
    const auto word = [&](size_t i) {
        uint32_t value = 0;
        std::memcpy(&value, module.data() + 4 * i, 4);
        return value;
    };
    if (words < kHeaderWords || word(0) != kMagic) return true; // not a module, or a module in the other byte order
    for (size_t at = kHeaderWords; at < words;) {
        const uint32_t length = word(at) >> 16, op = word(at) & 0xFFFF;
        if (length == 0 || length > words - at) return true;
        const size_t decoration = op == kDecorate ? at + 2 : op == kMemberDecorate ? at + 3 : 0;
        if (decoration && decoration + 1 < at + length && word(decoration) == kBuiltIn &&
            word(decoration + 1) == kFragCoord)
            return true;
        at += length;
    }
    return false;
}

} // namespace mural::shaders
