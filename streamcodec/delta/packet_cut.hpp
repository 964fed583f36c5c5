// Splits a packet of records into pieces: short records whole, long ones into a front (opcode, arguments and the bytes
// beyond whole pages) and pages. Equal texture data thus gives equal pages for any command.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "streamcodec/delta/limits.hpp"
#include "streamcodec/wire/record.hpp"
#include "streamcodec/wire/record_round.hpp"

namespace mural::delta {

struct Piece {
    uint32_t at = 0;
    uint32_t sizeBytes = 0;
    [[nodiscard]] bool page() const { return sizeBytes > kMaxTextBytes; }
};

// A position in a packet. A copy can look ahead.
class PacketCut {
public:
    PacketCut() = default;
    explicit PacketCut(std::span<const std::byte> packet) : packet_(packet) {}

    // Returns false at the end. After an invalid record length the rest belongs to no piece.
    [[nodiscard]] bool next(Piece& piece) {
        if (at_ < recordEnd_) {
            piece = {static_cast<uint32_t>(at_), kPageBytes};
            at_ += kPageBytes;
            return true;
        }
        const record::Header header = record::readHeader(packet_.data() + at_, packet_.size() - at_);
        if (!header) return false;
        const size_t sizeBytes = header.sizeBytes;
        ++records_;
        lastRecord_ = at_;
        recordEnd_ = at_ + sizeBytes;
        const size_t front = sizeBytes <= kMaxTextBytes ? sizeBytes : sizeBytes % kPageBytes;
        piece = {static_cast<uint32_t>(at_), static_cast<uint32_t>(front == 0 ? kPageBytes : front)};
        at_ += piece.sizeBytes;
        return true;
    }
    // Skips all following short records and returns their size in bytes.
    size_t passShort() {
        const size_t from = at_;
        if (!atRecord()) return 0;
        RecordRound round;
        while (packet_.size() - at_ >= 4) {
            uint32_t head = 0;
            std::memcpy(&head, packet_.data() + at_, 4);
            if (round.closes(head)) {
                const size_t lastBytes = at_ - lastRecord_, rounds = round.pass(packet_, at_);
                records_ += rounds * round.size();
                lastRecord_ = at_ - lastBytes;
                if (rounds > 0) continue;
            }
            const size_t sizeBytes = size_t{head >> 16} * 4;
            // zero, long, or truncated
            if (sizeBytes - 4 > kMaxTextBytes - 4 || sizeBytes > packet_.size() - at_) break;
            round.add(head, at_);
            lastRecord_ = at_;
            at_ += sizeBytes;
            ++records_;
        }
        recordEnd_ = at_;
        return at_ - from;
    }
    // Skips short records of a known total size; `lastBytes`: size of the last one.
    void passed(size_t records, size_t bytes, size_t lastBytes) {
        records_ += records;
        at_ += bytes;
        if (records > 0) lastRecord_ = at_ - lastBytes;
        recordEnd_ = at_;
    }

    [[nodiscard]] bool atRecord() const { return at_ >= recordEnd_; }
    [[nodiscard]] size_t at() const { return at_; }
    [[nodiscard]] uint64_t records() const { return records_; }
    [[nodiscard]] uint32_t lastOpcode() const { // 0: none
        uint32_t head = 0;
        if (records_ > 0) std::memcpy(&head, packet_.data() + lastRecord_, 4);
        return head & 0xffff;
    }

private:
    std::span<const std::byte> packet_;
    size_t at_ = 0;
    size_t recordEnd_ = 0; // end of the current record
    size_t lastRecord_ = 0;
    uint64_t records_ = 0;
};

} // namespace mural::delta
