#include "tools/mural/netperf/stream_pattern.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "common/base/little_endian.hpp"

namespace mural::cli {

namespace {

// Word n is (n + 1) times an odd number modulo 2^64: all words differ, and the inverse gives their position.
constexpr size_t kWordBytes = 8;
constexpr uint64_t kFactor = 0x9e3779b97f4a7c15u;

constexpr uint64_t inverseOf(uint64_t odd) {
    uint64_t inverse = odd; // 3 correct bits; each Newton step doubles them
    for (int i = 0; i < 5; ++i) inverse *= 2 - odd * inverse;
    return inverse;
}
static_assert(kFactor * inverseOf(kFactor) == 1);

constexpr uint64_t kMaxWords = uint64_t{1} << 60; // larger results are chance

bool isFilled(std::span<const std::byte> bytes, uint64_t position) {
    std::array<std::byte, kWordBytes> right;
    const auto expected = std::span(right).first(bytes.size());
    fillPattern(expected, position);
    return std::ranges::equal(bytes, expected);
}

// Compares without building a copy, whose cost would distort netperf's measurement.
bool isPattern(std::span<const std::byte> bytes, uint64_t position) {
    const size_t before = std::min(bytes.size(), (kWordBytes - position % kWordBytes) % kWordBytes);
    const auto words = bytes.subspan(before, (bytes.size() - before) / kWordBytes * kWordBytes);
    uint64_t word = ((position + before) / kWordBytes + 1) * kFactor;
    uint64_t wrong = 0;
    for (size_t at = 0; at < words.size(); at += kWordBytes, word += kFactor)
        wrong |= loadLittle<uint64_t>(words.data() + at) ^ word;
    const size_t behind = before + words.size();
    return wrong == 0 && isFilled(bytes.first(before), position) && isFilled(bytes.subspan(behind), position + behind);
}

} // namespace

void fillPattern(std::span<std::byte> into, uint64_t position) {
    uint64_t word = (position / kWordBytes + 1) * kFactor;
    const size_t skipped = position % kWordBytes;
    std::array<std::byte, kWordBytes> cut;
    if (skipped != 0) {
        storeLittle(cut.data(), word);
        const size_t count = std::min(into.size(), kWordBytes - skipped);
        std::copy_n(cut.begin() + static_cast<std::ptrdiff_t>(skipped), count, into.begin());
        into = into.subspan(count);
        word += kFactor;
    }
    for (; into.size() >= kWordBytes; into = into.subspan(kWordBytes), word += kFactor) storeLittle(into.data(), word);
    storeLittle(cut.data(), word);
    std::copy_n(cut.begin(), into.size(), into.begin());
}

std::optional<uint64_t> findPattern(std::span<const std::byte> bytes) {
    if (bytes.size() < kFindBytes) return {};
    for (size_t skipped = 0; skipped < kWordBytes; ++skipped) {
        const uint64_t word = loadLittle<uint64_t>(bytes.data() + skipped);
        const uint64_t position = (word * inverseOf(kFactor) - 1) * kWordBytes;
        if (position / kWordBytes >= kMaxWords || position < skipped) continue;
        if (loadLittle<uint64_t>(bytes.data() + skipped + kWordBytes) != word + kFactor) continue;
        return position - skipped;
    }
    return {};
}

void PatternCheck::take(std::span<const std::byte> bytes) {
    if (!fault_.empty()) return;
    if (found_) return compare(bytes);
    first_.insert(first_.end(), bytes.begin(), bytes.end());
    if (first_.size() < kFindBytes) return;
    const auto position = findPattern(first_);
    if (!position) {
        fault_ = "the first received bytes do not occur in the stream";
        return;
    }
    found_ = true;
    position_ = beganAt_ = *position;
    compare(first_);
    first_ = {};
}

void PatternCheck::compare(std::span<const std::byte> bytes) {
    constexpr size_t kPieceBytes = 4096;
    while (!bytes.empty()) {
        const auto piece = bytes.first(std::min(bytes.size(), kPieceBytes));
        if (!isPattern(piece, position_)) {
            std::vector<std::byte> expected(piece.size());
            fillPattern(expected, position_);
            const auto wrongAt = static_cast<size_t>(std::ranges::mismatch(piece, expected).in1 - piece.begin());
            const uint64_t position = position_ + wrongAt;
            const auto arrived = findPattern(bytes.subspan(wrongAt));
            fault_ = arrived && *arrived != position
                         ? fmt::format("byte {} has the contents of byte {}", position, *arrived)
                         : fmt::format("byte {} was changed", position);
            return;
        }
        position_ += piece.size();
        bytes = bytes.subspan(piece.size());
    }
}

} // namespace mural::cli
