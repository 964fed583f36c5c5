// The records of a packet, one after another (docs/wire-format.md), without looking into their arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "streamcodec/record.hpp"
#include "streamcodec/record_round.hpp"
#include "streamcodec/walked.hpp"

namespace mural::recording {

struct RecordView {
    uint16_t opcode = 0;
    size_t offset = 0;                     // in the packet, bytes
    size_t sizeBytes = 0;                  // with its header
    std::span<const std::byte> arguments;
};

class RecordWalk {
public:
    explicit RecordWalk(std::span<const std::byte> packet) : packet_(packet) {}

    // False at the end, and where a record is longer than what is left: malformed() then.
    bool next(RecordView& record) {
        const size_t left = packet_.size() - at_;
        if (left == 0 || malformed_) return false;
        uint64_t words = 0;
        size_t headerBytes = 4;
        if (left >= 4) words = word(at_) >> 16;
        if (words == record::kLongForm && left >= 8) {
            headerBytes = 8;
            words = word(at_ + 4);
        }
        malformed_ = words * 4 < headerBytes || words * 4 > left;
        if (malformed_) return false;
        record.opcode = static_cast<uint16_t>(word(at_));
        record.offset = at_;
        record.sizeBytes = static_cast<size_t>(words) * 4;
        record.arguments = packet_.subspan(at_ + headerBytes, record.sizeBytes - headerBytes);
        at_ += record.sizeBytes;
        walked_.pass(record.offset, record.sizeBytes);
        return true;
    }
    // On over short records as long as they are of no interest, by their opcode: asked once for so many of them, always the same of
    // the same; of a round's, which come by turns, for all turns.
    // A program that loads says hundreds of thousands in one frame: what changes with each is kept in locals, as what is called
    // might look at this.
    template <typename OfNoInterest>
    void skip(const OfNoInterest& ofNoInterest) {
        const std::span<const std::byte> packet = packet_;
        size_t at = at_, records = 0, lastBytes = 0;
        const auto passOne = [&](uint32_t head) {
            const size_t sizeBytes = (head >> 16) * size_t{4};
            if (sizeBytes == 0 || head >> 16 == record::kLongForm || sizeBytes > packet.size() - at || !ofNoInterest(static_cast<uint16_t>(head), size_t{1})) return false;
            if (sizeBytes > kMostShortRecordBytes) walked_.longAt.push_back(static_cast<uint32_t>(at));
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
        // Where much is of interest, stretches are too short for rounds.
        uint32_t head = 0;
        bool more = true;
        while (records < kBeforeRounds && more) more = headHere(head) && passOne(head);
        if (more) {
            RecordRound round;
            while (headHere(head)) {
                if (round.closes(head)) {
                    const size_t rounds = round.pass(packet, at);
                    for (size_t k = 0; rounds > 0 && k < round.size(); ++k) ofNoInterest(static_cast<uint16_t>(round.head(k)), rounds);
                    records += rounds * round.size();
                    if (rounds > 0) continue;
                }
                const size_t from = at;
                if (!passOne(head)) break;
                if (lastBytes > kMostShortRecordBytes) round.begin(); // each of those is told of
                else round.add(head, from);
            }
        }
        at_ = at;
        if (records == 0) return;
        walked_.records += records;
        walked_.lastBytes = lastBytes;
    }
    // What pass() does with a record.
    enum class Interest : uint8_t { None, Look, Stop };
    // As skip(), but those of Interest::Look are given to look() on the way, one by one; false: the walk stops before that one. A loop of its own:
    // one for both took 0.5 to 5 us more for a frame of some hundred records, as less of it was kept in registers.
    template <typename InterestOf, typename Looks>
    void pass(const InterestOf& interestOf, const Looks& look) {
        const std::span<const std::byte> packet = packet_;
        size_t at = at_, records = 0, lastBytes = 0;
        uint32_t head = 0;
        if (packet.size() - at < sizeof head) return;
        std::memcpy(&head, packet.data() + at, sizeof head);
        if (interestOf(static_cast<uint16_t>(head)) == Interest::Stop) return; // as where primitives are short
        RecordRound round;
        size_t unlooked = 0; // in a row
        while (packet.size() - at >= sizeof head) {
            std::memcpy(&head, packet.data() + at, sizeof head);
            if (unlooked >= kBeforeRounds && round.closes(head)) {
                const size_t rounds = round.pass(packet, at);
                records += rounds * round.size();
                if (rounds > 0) continue;
            }
            const size_t sizeBytes = (head >> 16) * size_t{4};
            if (sizeBytes == 0 || head >> 16 == record::kLongForm || sizeBytes > packet.size() - at) break;
            const Interest interest = interestOf(static_cast<uint16_t>(head));
            if (interest == Interest::Stop) break;
            if (interest == Interest::Look) {
                if (!look(RecordView{static_cast<uint16_t>(head), at, sizeBytes, packet.subspan(at + 4, sizeBytes - 4)})) break;
                if (unlooked >= kBeforeRounds) round.begin();
                unlooked = 0;
            } else if (unlooked >= kBeforeRounds) {
                round.add(head, at);
            } else {
                ++unlooked;
            }
            if (sizeBytes > kMostShortRecordBytes) { // each of those is told of
                walked_.longAt.push_back(static_cast<uint32_t>(at));
                round.begin();
            }
            at += sizeBytes;
            lastBytes = sizeBytes; // of rounds, too: what they end with came before them
            ++records;
        }
        at_ = at;
        if (records == 0) return;
        walked_.records += records;
        walked_.lastBytes = lastBytes;
    }
    [[nodiscard]] size_t at() const { return at_; } // where the next record begins, bytes
    // Behind records that somebody else has passed.
    void goTo(size_t at, const Walked& passed) {
        at_ = at;
        walked_.add(passed);
    }
    // All of the packet, once there is no next record; null: that is not all records.
    [[nodiscard]] const Walked* whole() const { return at_ == packet_.size() && !malformed_ ? &walked_ : nullptr; }
    [[nodiscard]] bool malformed() const { return malformed_; }

private:
    [[nodiscard]] uint32_t word(size_t at) const {
        uint32_t value = 0;
        std::memcpy(&value, packet_.data() + at, sizeof value);
        return value;
    }

    static constexpr size_t kBeforeRounds = 8;

    std::span<const std::byte> packet_;
    size_t at_ = 0;
    bool malformed_ = false;
    Walked walked_;
};

// A word of a record's arguments; 0 behind their end.
inline uint32_t argumentWord(const RecordView& record, size_t index) {
    uint32_t value = 0;
    if ((index + 1) * 4 <= record.arguments.size()) std::memcpy(&value, record.arguments.data() + index * 4, sizeof value);
    return value;
}

} // namespace mural::recording
