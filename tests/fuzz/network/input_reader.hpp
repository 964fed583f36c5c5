// Takes a fuzzer's bytes apart: numbers and pieces; what is not there is zero or empty.
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
    // A length of two bytes and what stands behind it: a copy of exactly this size, so that a sanitizer sees the first
    // byte read behind it.
    std::vector<std::byte> piece() {
        const size_t told = half(); // before the size is asked for
        const size_t count = std::min(told, left_.size());
        const auto taken = left_.first(count);
        left_ = left_.subspan(count);
        return {taken.begin(), taken.end()};
    }

private:
    std::span<const std::byte> left_;
};

// A byte of it is another, unless there is none at that place or nothing is changed in it. Returns whether it is.
inline bool change(std::span<std::byte> bytes, size_t at, uint8_t bits) {
    if (at >= bytes.size() || bits == 0) return false;
    bytes[at] ^= static_cast<std::byte>(bits);
    return true;
}

} // namespace mural::fuzz
