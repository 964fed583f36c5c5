// Splits a fuzzer's bytes into numbers and pieces. Missing bytes are zero, or an empty piece.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::fuzz {

class InputReader {
public:
    explicit InputReader(std::span<const std::byte> left) : left_(left) {}

    [[nodiscard]] bool empty() const { return left_.empty(); }
    uint8_t byte() {
        if (left_.empty()) return 0;
        const auto value = std::to_integer<uint8_t>(left_.front());
        left_ = left_.subspan(1);
        return value;
    }
    uint16_t half() {
        const uint16_t low = byte();
        return static_cast<uint16_t>(low | byte() << 8);
    }
    uint32_t word() {
        const uint32_t low = half();
        return low | static_cast<uint32_t>(half()) << 16;
    }
    // Reads a length of two bytes and the bytes after it. Returns a copy of exactly this size, so that a sanitizer
    // detects the first byte read beyond it.
    std::vector<std::byte> piece() {
        const size_t wanted = half(); // read before size() is evaluated
        const size_t count = std::min(wanted, left_.size());
        const auto taken = left_.first(count);
        left_ = left_.subspan(count);
        return {taken.begin(), taken.end()};
    }

private:
    std::span<const std::byte> left_;
};

// Changes the byte at `at`, if there is one and `bits` is not 0. Returns whether it changed.
inline bool change(std::span<std::byte> bytes, size_t at, uint8_t bits) {
    if (at >= bytes.size() || bits == 0) return false;
    bytes[at] ^= static_cast<std::byte>(bits);
    return true;
}

} // namespace mural::fuzz
