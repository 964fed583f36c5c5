// Which words of an item have changed against the expected one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "economy/control_code.hpp"

namespace mural::economy {

struct WordSpan {
    uint32_t kept = 0;    // words left as they are, since the last span
    uint32_t changed = 0; // words that follow
};

struct WordPatch {
    std::vector<WordSpan> spans;
    size_t costBytes = 0; // spans and words

    // Both of the same size, a multiple of 4. False as soon as it costs more than `mostBytes`.
    bool find(std::span<const std::byte> old, std::span<const std::byte> now, size_t mostBytes) {
        spans.clear();
        costBytes = 0;
        const auto words = static_cast<uint32_t>(now.size() / 4);
        const auto equal = [&](uint32_t w) { return std::memcmp(old.data() + size_t{w} * 4, now.data() + size_t{w} * 4, 4) == 0; };
        for (uint32_t w = 0, from = 0; w < words;) {
            // Pages have long equal parts.
            while (words - w >= 16 && std::memcmp(old.data() + size_t{w} * 4, now.data() + size_t{w} * 4, 64) == 0) w += 16;
            while (w < words && equal(w)) ++w;
            if (w == words) break;
            const uint32_t begin = w;
            while (w < words && !equal(w)) ++w;
            spans.push_back({begin - from, w - begin});
            costBytes += ControlWriter::spanBytes(begin - from, w - begin) + size_t{w - begin} * 4;
            if (costBytes > mostBytes) return false;
            from = w;
        }
        return !spans.empty();
    }
};

} // namespace mural::economy
