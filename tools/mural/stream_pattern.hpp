// The bytes that `mural netperf` sends. Each word of eight bytes tells its place in the stream, so a reader sees by the bytes
// alone what is missing, came twice, out of order or changed, and a late one where it began to listen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mural::cli {

// What belongs at a place of the stream, counted in bytes.
void fillPattern(std::span<std::byte> into, uint64_t place);
// Which place these bytes are of; none when they are too few (below kFindBytes), or no place's.
std::optional<uint64_t> findPattern(std::span<const std::byte> bytes);
constexpr size_t kFindBytes = 7 + 2 * 8; // two whole words, wherever they begin

// A reader's side: takes what came, in pieces of any size.
class PatternCheck {
public:
    // The first kFindBytes tell the place; less than that is not looked at.
    void take(std::span<const std::byte> bytes);
    // What was wrong first; empty: nothing.
    [[nodiscard]] const std::string& fault() const { return fault_; }
    // The first byte's place; 0 until it is known.
    [[nodiscard]] uint64_t beganAt() const { return beganAt_; }

private:
    void compare(std::span<const std::byte> bytes);

    bool found_ = false;
    uint64_t beganAt_ = 0;
    uint64_t place_ = 0; // of the next byte
    std::vector<std::byte> first_; // until the place is found
    std::string fault_;
};

} // namespace mural::cli
