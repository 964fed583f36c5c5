// Cuts a packet of records into items: short records whole, of long ones first what is left over beside whole pages (so the
// opcode and the arguments in front), then the pages. So the bytes of a texture are the same pages whatever command has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "economy/limits.hpp"
#include "streamcodec/record.hpp"
#include "streamcodec/record_round.hpp"

namespace mural::economy {

struct Piece {
    uint32_t at = 0;
    uint32_t sizeBytes = 0;
    [[nodiscard]] bool page() const { return sizeBytes > kMostTextBytes; }
};

// A place in a packet. A copy looks ahead.
class PacketCut {
public:
    PacketCut() = default;
    explicit PacketCut(std::span<const std::byte> packet) : packet_(packet) {}

    // False: there is none. Where a record's length makes no sense, the rest is no items.
    [[nodiscard]] bool next(Piece& piece) {
        if (at_ < recordEnd_) {
            piece = {static_cast<uint32_t>(at_), kPageBytes};
            at_ += kPageBytes;
            return true;
        }
        if (packet_.size() - at_ < 4) return false;
        uint32_t head[2] = {};
        std::memcpy(head, packet_.data() + at_, packet_.size() - at_ >= 8 ? 8 : 4);
        const uint32_t words = head[0] >> 16 == record::kLongForm ? head[1] : head[0] >> 16;
        const size_t sizeBytes = size_t{words} * 4;
        if (words == 0 || sizeBytes > packet_.size() - at_) return false;
        ++records_;
        lastRecord_ = at_;
        recordEnd_ = at_ + sizeBytes;
        const size_t front = sizeBytes <= kMostTextBytes ? sizeBytes : sizeBytes % kPageBytes;
        piece = {static_cast<uint32_t>(at_), static_cast<uint32_t>(front == 0 ? kPageBytes : front)};
        at_ += piece.sizeBytes;
        return true;
    }
    // Behind all short records that follow here; how many bytes they are.
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
            if (sizeBytes - 4 > kMostTextBytes - 4 || sizeBytes > packet_.size() - at_) break; // 0, or a long one, or none
            round.add(head, at_);
            lastRecord_ = at_;
            at_ += sizeBytes;
            ++records_;
        }
        recordEnd_ = at_;
        return at_ - from;
    }
    // So many short records are behind, the last of them of so many bytes.
    void passed(size_t records, size_t bytes, size_t lastBytes) {
        records_ += records;
        at_ += bytes;
        if (records > 0) lastRecord_ = at_ - lastBytes;
        recordEnd_ = at_;
    }

    [[nodiscard]] bool atRecord() const { return at_ >= recordEnd_; }
    [[nodiscard]] size_t at() const { return at_; }
    [[nodiscard]] uint64_t records() const { return records_; }
    [[nodiscard]] uint32_t lastOpcode() const { // 0: there was none
        uint32_t head = 0;
        if (records_ > 0) std::memcpy(&head, packet_.data() + lastRecord_, 4);
        return head & 0xffff;
    }

private:
    std::span<const std::byte> packet_;
    size_t at_ = 0;
    size_t recordEnd_ = 0; // of the record that has begun
    size_t lastRecord_ = 0;
    uint64_t records_ = 0;
};

} // namespace mural::economy
