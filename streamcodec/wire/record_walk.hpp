// Iterates over the records of a packet (docs/reference/wire-format.md) without parsing their arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "streamcodec/wire/record.hpp"
#include "streamcodec/wire/record_round.hpp"
#include "streamcodec/wire/record_offsets.hpp"

namespace mural::wire {

struct RecordView {
    uint16_t opcode = 0;
    size_t offset = 0;    // offset in the packet, in bytes
    size_t sizeBytes = 0; // including its header
    std::span<const std::byte> arguments;
};

class RecordWalk {
public:
    explicit RecordWalk(std::span<const std::byte> packet) : packet_(packet) {}

    // Returns false at the end, and for a record longer than the rest; malformed() distinguishes them.
    bool next(RecordView& record) {
        const size_t left = packet_.size() - at_;
        if (left == 0 || malformed_) return false;
        const record::Header header = record::readHeader(packet_.data() + at_, left);
        malformed_ = !header;
        if (malformed_) return false;
        record.opcode = header.opcode;
        record.offset = at_;
        record.sizeBytes = header.sizeBytes;
        record.arguments = packet_.subspan(at_ + header.headerBytes, record.sizeBytes - header.headerBytes);
        at_ += record.sizeBytes;
        walked_.pass(record.offset, record.sizeBytes);
        return true;
    }
    // Skips short records while their opcode is of no interest. The predicate must be pure: it is evaluated once per
    // run of equal records, or once per round of alternating records. A loading program sends hundreds of thousands of
    // records in one frame, so the loop keeps its state in locals, which the predicate cannot alias.
    template <typename OfNoInterest> void skip(const OfNoInterest& ofNoInterest) {
        const std::span<const std::byte> packet = packet_;
        size_t at = at_, records = 0, lastBytes = 0;
        const auto passOne = [&](uint32_t head) {
            const size_t sizeBytes = (head >> 16) * size_t{4};
            if (sizeBytes == 0 || record::isLongForm(head) || sizeBytes > packet.size() - at ||
                !ofNoInterest(static_cast<uint16_t>(head), size_t{1}))
                return false;
            if (sizeBytes > kMaxShortRecordBytes) walked_.longAt.push_back(static_cast<uint32_t>(at));
            at += sizeBytes;
            lastBytes = sizeBytes;
            ++records;
            return true;
        };
        const auto headHere = [&](uint32_t& head) {
            if (packet.size() - at < sizeof head) return false;
            std::memcpy(&head, packet.data() + at, sizeof head);
            return true;
        };
        // With many interesting records the runs are too short for rounds.
        uint32_t head = 0;
        bool more = true;
        while (records < kBeforeRounds && more) more = headHere(head) && passOne(head);
        if (more) {
            RecordRound round;
            while (headHere(head)) {
                if (round.closes(head)) {
                    const size_t rounds = round.pass(packet, at);
                    for (size_t k = 0; rounds > 0 && k < round.size(); ++k)
                        ofNoInterest(static_cast<uint16_t>(round.head(k)), rounds);
                    records += rounds * round.size();
                    if (rounds > 0) continue;
                }
                const size_t from = at;
                if (!passOne(head)) break;
                if (lastBytes > kMaxShortRecordBytes)
                    round.begin(); // long records are always reported
                else
                    round.add(head, from);
            }
        }
        at_ = at;
        if (records == 0) return;
        walked_.records += records;
        walked_.lastBytes = lastBytes;
    }
    // Action of pass() for a record.
    enum class Interest : uint8_t { None, Examine, Stop };
    // As skip(), but passes records of Interest::Examine to examine() one by one; its result false stops before that
    // record. A separate loop: a common one kept less state in registers and took 0.5 to 5 us longer per frame of some
    // hundred records.
    template <typename InterestOf, typename Examine> void pass(const InterestOf& interestOf, const Examine& examine) {
        const std::span<const std::byte> packet = packet_;
        size_t at = at_, records = 0, lastBytes = 0;
        uint32_t head = 0;
        if (packet.size() - at < sizeof head) return;
        std::memcpy(&head, packet.data() + at, sizeof head);
        if (interestOf(static_cast<uint16_t>(head)) == Interest::Stop) return; // typical for short primitives
        RecordRound round;
        size_t skipped = 0; // consecutive
        while (packet.size() - at >= sizeof head) {
            std::memcpy(&head, packet.data() + at, sizeof head);
            if (skipped >= kBeforeRounds && round.closes(head)) {
                const size_t rounds = round.pass(packet, at);
                records += rounds * round.size();
                if (rounds > 0) continue;
            }
            const size_t sizeBytes = (head >> 16) * size_t{4};
            if (sizeBytes == 0 || record::isLongForm(head) || sizeBytes > packet.size() - at) break;
            const Interest interest = interestOf(static_cast<uint16_t>(head));
            if (interest == Interest::Stop) break;
            if (interest == Interest::Examine) {
                if (!examine(
                        RecordView{static_cast<uint16_t>(head), at, sizeBytes, packet.subspan(at + 4, sizeBytes - 4)}))
                    break;
                if (skipped >= kBeforeRounds) round.begin();
                skipped = 0;
            } else if (skipped >= kBeforeRounds) {
                round.add(head, at);
            } else {
                ++skipped;
            }
            if (sizeBytes > kMaxShortRecordBytes) { // long records are always reported
                walked_.longAt.push_back(static_cast<uint32_t>(at));
                round.begin();
            }
            at += sizeBytes;
            lastBytes = sizeBytes; // also in rounds, whose last record was seen before
            ++records;
        }
        at_ = at;
        if (records == 0) return;
        walked_.records += records;
        walked_.lastBytes = lastBytes;
    }
    [[nodiscard]] size_t at() const { return at_; } // offset of the next record, in bytes
    // Continues after records that another component has passed.
    void goTo(size_t at, const RecordOffsets& passed) {
        at_ = at;
        walked_.add(passed);
    }
    // Returns the offsets of the whole packet after the last record; null if it does not consist of records only.
    [[nodiscard]] const RecordOffsets* whole() const {
        return at_ == packet_.size() && !malformed_ ? &walked_ : nullptr;
    }
    [[nodiscard]] bool malformed() const { return malformed_; }

private:
    static constexpr size_t kBeforeRounds = 8;

    std::span<const std::byte> packet_;
    size_t at_ = 0;
    bool malformed_ = false;
    RecordOffsets walked_;
};

// Returns a word of a record's arguments; 0 after their end.
inline uint32_t argumentWord(const RecordView& record, size_t index) {
    uint32_t value = 0;
    if ((index + 1) * 4 <= record.arguments.size())
        std::memcpy(&value, record.arguments.data() + index * 4, sizeof value);
    return value;
}

} // namespace mural::wire
