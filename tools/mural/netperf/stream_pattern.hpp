// Test data of `mural netperf`. Each word of eight bytes encodes its position in the stream, so a reader detects
// missing, duplicate, reordered and changed bytes, and a late one its start position.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mural::cli {

// Fills with the data of a position in bytes.
void fillPattern(std::span<std::byte> into, uint64_t position);
// Returns the position of these bytes; empty if they are too few (below kFindBytes) or not part of the pattern.
std::optional<uint64_t> findPattern(std::span<const std::byte> bytes);
constexpr size_t kFindBytes = 7 + 2 * 8; // contains two whole words at any alignment

// Checks received data, in pieces of any size.
class PatternCheck {
public:
    // The first kFindBytes determine the position; fewer bytes are not checked.
    void take(std::span<const std::byte> bytes);
    // Returns the first error; empty: none.
    [[nodiscard]] const std::string& fault() const { return fault_; }
    // Returns the position of the first byte; 0 until it is known.
    [[nodiscard]] uint64_t beganAt() const { return beganAt_; }

private:
    void compare(std::span<const std::byte> bytes);

    bool found_ = false;
    uint64_t beganAt_ = 0;
    uint64_t position_ = 0;        // of the next byte
    std::vector<std::byte> first_; // until the position is known
    std::string fault_;
};

} // namespace mural::cli
