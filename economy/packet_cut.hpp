// Cuts a packet of records into items: short records whole, of long ones first what is left over beside whole pages (so the
// opcode and the arguments in front), then the pages. So the bytes of a texture are the same pages whatever command has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "economy/limits.hpp"
#include "streamcodec/record.hpp"

namespace mural::economy {

struct Piece {
    uint32_t at = 0;
    uint32_t sizeBytes = 0;
    [[nodiscard]] bool page() const { return sizeBytes > kMostTextBytes; }
};

struct CutPacket {
    size_t sizeBytes = 0; // of the pieces: all, or less when a record's length makes no sense; the rest is no items then
    uint64_t records = 0;
    uint32_t lastOpcode = 0;
};

inline CutPacket cutPacket(std::span<const std::byte> packet, std::vector<Piece>& pieces) {
    pieces.clear();
    CutPacket cut;
    size_t at = 0;
    while (packet.size() - at >= 4) {
        uint32_t head[2] = {};
        std::memcpy(head, packet.data() + at, packet.size() - at >= 8 ? 8 : 4);
        const uint32_t words = head[0] >> 16 == record::kLongForm ? head[1] : head[0] >> 16;
        const size_t sizeBytes = size_t{words} * 4;
        if (words == 0 || sizeBytes > packet.size() - at) break;
        ++cut.records;
        cut.lastOpcode = head[0] & 0xffff;
        if (sizeBytes <= kMostTextBytes) {
            pieces.push_back({static_cast<uint32_t>(at), words * 4});
            at += sizeBytes;
            continue;
        }
        const size_t end = at + sizeBytes;
        if (const size_t front = sizeBytes % kPageBytes) {
            pieces.push_back({static_cast<uint32_t>(at), static_cast<uint32_t>(front)});
            at += front;
        }
        for (; at < end; at += kPageBytes) pieces.push_back({static_cast<uint32_t>(at), kPageBytes});
    }
    cut.sizeBytes = at;
    return cut;
}

} // namespace mural::economy
