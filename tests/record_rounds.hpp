// Makes packets for tests that walk over records: repeated rounds with few commands and lengths, and other records
// between.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace mural::testing {

// Appends a record of `words` words with its header; words 0: an invalid header.
inline void putRecord(std::vector<std::byte>& packet, uint32_t opcode, uint32_t words) {
    const uint32_t head = words << 16 | opcode;
    const size_t at = packet.size();
    packet.resize(at + std::max<size_t>(4, size_t{words} * 4), std::byte{0x5a});
    std::memcpy(packet.data() + at, &head, sizeof head);
}

// Appends rounds of opcodes 1 to 5 with 1 to 6 words, and rarely with about the maximum of a short record. Calls
// `between(packet)` after some rounds.
template <typename Between> std::vector<std::byte> recordRounds(std::mt19937& random, const Between& between) {
    std::vector<std::byte> packet;
    const auto below = [&](uint32_t n) { return random() % n; };
    for (uint32_t part = below(12); part > 0; --part) {
        const size_t from = packet.size();
        for (uint32_t n = 1 + below(20); n > 0; --n)
            putRecord(packet, 1 + below(5), below(60) == 0 ? 255 + below(4) : 1 + below(6));
        const std::vector<std::byte> round(packet.begin() + static_cast<std::ptrdiff_t>(from), packet.end());
        for (uint32_t n = below(9); n > 0; --n) packet.insert(packet.end(), round.begin(), round.end());
        if (below(3) == 0) putRecord(packet, 1 + below(5), 1 + below(6));
        if (below(6) == 0) between(packet);
    }
    return packet;
}

} // namespace mural::testing
