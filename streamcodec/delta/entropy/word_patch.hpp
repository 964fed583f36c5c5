// The changed words of an entry relative to the expected one.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "streamcodec/delta/entropy/changed_words.hpp"
#include "streamcodec/delta/control_code.hpp"

namespace mural::delta {

struct WordSpan {
    uint32_t unchanged = 0; // unchanged words since the last span
    uint32_t changed = 0;   // changed words that follow
};

class WordPatch {
public:
    std::vector<WordSpan> spans;
    size_t costBytes = 0;    // of spans and words
    size_t changedBytes = 0; // of words

    // Compares two entries of equal size, a multiple of 4. Returns false as soon as the cost exceeds `maxBytes`.
    bool find(std::span<const std::byte> old, std::span<const std::byte> now, size_t maxBytes) {
        spans.clear();
        costBytes = changedBytes = 0;
        const auto words = static_cast<uint32_t>(now.size() / 4);
        size_t changed = 0; // in words
        uint32_t w = 0, from = 0, block = 0;
        uint64_t bits = 0; // remaining changed words of the block
        const auto load = [&](uint32_t at) {
            bits = at + kBlock <= words
                       ? changedWords(old.data() + size_t{at} * 4, now.data() + size_t{at} * 4)
                       : changedOf(old.data() + size_t{at} * 4, now.data() + size_t{at} * 4, words - at);
        };
        for (; block < words; block += kBlock) {
            load(block);
            while (bits != 0) {
                w = block + static_cast<uint32_t>(std::countr_zero(bits));
                const uint32_t begin = w;
                // Find the end of the run, possibly in a later block.
                while (true) {
                    const auto ones = static_cast<uint32_t>(std::countr_one(bits >> (w - block)));
                    w += ones;
                    if (w - block < kBlock) {
                        bits &= ~uint64_t{0} << (w - block);
                        break;
                    }
                    bits = 0;
                    if (w >= words) break;
                    block += kBlock;
                    load(block);
                }
                spans.push_back({begin - from, w - begin});
                costBytes += ControlWriter::spanBytes(begin - from, w - begin) + size_t{w - begin} * 4;
                if (costBytes > maxBytes) return false;
                changed += w - begin;
                from = w;
            }
        }
        changedBytes = changed * 4;
        return !spans.empty();
    }

    // Changes `old`, the argument of find(), into `now`.
    void apply(std::span<const std::byte> now, std::span<std::byte> old) const {
        if (spans.size() * kCopiedAtOnce > now.size()) { // faster than span by span
            std::memcpy(old.data(), now.data(), now.size());
            return;
        }
        size_t at = 0;
        for (const WordSpan& span : spans) {
            at += size_t{span.unchanged} * 4;
            const size_t sizeBytes = size_t{span.changed} * 4;
            std::memcpy(old.data() + at, now.data() + at, sizeBytes);
            at += sizeBytes;
        }
    }

private:
    static constexpr uint32_t kBlock = kComparedWords;
    static constexpr size_t kCopiedAtOnce = 256; // bytes per span

    // Returns one bit per word.
    static uint64_t changedOf(const std::byte* old, const std::byte* now, uint32_t words) {
        uint64_t bits = 0;
        for (uint32_t i = 0; i < words; ++i)
            bits |= uint64_t{std::memcmp(old + size_t{i} * 4, now + size_t{i} * 4, 4) != 0} << i;
        return bits;
    }
};

} // namespace mural::delta
