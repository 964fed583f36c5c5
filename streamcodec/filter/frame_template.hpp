// Template of a frame: the positions of its records, and the bytes that determine bindings. The next frame is compared
// at these positions, so no record has to be read to find the next one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "streamcodec/wire/record_offsets.hpp"

namespace mural::filter {

// The part of a record that must match.
enum class Same : uint8_t {
    Head, // command and length
    All,
    Seen, // command only: the record is examined each time, with any length
};

class FrameTemplate {
public:
    void clear();
    // Appends a record. Returns false if the limit is reached.
    bool add(Same same, std::span<const std::byte> record);

    // Restarts at the first record.
    void begin();
    enum class Stop : uint8_t { PacketEnds, Seen, Differs, End };
    // Advances while the packet matches, from a record at `at`. On return `at` is at the start of a record.
    Stop pass(std::span<const std::byte> packet, size_t& at, RecordOffsets& walked);
    // Continues after an examined record. Returns false if it is another command.
    bool passSeen(uint16_t opcode);
    [[nodiscard]] bool atEnd() const { return range_ == ranges_.size(); }
    // matched fraction
    [[nodiscard]] double share() const {
        return totalBytes_ == 0 ? 0 : static_cast<double>(at_) / static_cast<double>(totalBytes_);
    }
    [[nodiscard]] bool empty() const { return ranges_.empty(); }
    // Passes the matched records of Same::All that were not passed yet, and returns their number.
    [[nodiscard]] size_t passed() const;
    [[nodiscard]] size_t tracked() const { return tracked_; }
    template <typename Give> void track(size_t to, const Give& give) {
        for (; tracked_ < to; ++tracked_)
            give(std::as_bytes(std::span(same_))
                     .subspan(whole_[tracked_].sameAt * size_t{4}, whole_[tracked_].sizeBytes));
    }
    void trackFrom(size_t count) { tracked_ = count; } // the caller has tracked the earlier ones

private:
    static constexpr uint32_t kSeen = UINT32_MAX;
    static constexpr size_t kMaxRecords = size_t{1} << 18, kMaxSameBytes = size_t{8} << 20;
    // irrelevant gaps up to this size are compared anyway, which is faster than skipping them
    static constexpr size_t kShortBytes = 256;
    struct Range {
        uint32_t sameBytes = 0;
        uint32_t otherBytes = 0; // irrelevant bytes after the range; kSeen: an examined record
    };
    struct Whole {
        uint32_t at = 0, sameAt = 0 /* words */, sizeBytes = 0;
    };
    void keep(const std::byte* record, size_t sizeBytes, uint32_t matters);
    // Returns the number of matching bytes in whole words.
    [[nodiscard]] size_t likeBytes(const std::byte* packet, size_t sameAt, size_t sizeBytes) const;
    Stop passTo(std::span<const std::byte> packet, size_t& at);
    void passWhole(std::span<const std::byte> packet, size_t& at);
    void go(size_t sizeBytes, size_t& at);
    void backToRecord(uint64_t differsAt, size_t& at);

    // Positions exclude the bytes of examined records.
    std::vector<Range> ranges_;
    std::vector<uint32_t> same_;    // expected words, contiguous; of short records including irrelevant ones
    std::vector<uint32_t> matters_; // masks of the relevant bits
    std::vector<uint32_t> starts_;
    std::vector<Whole> whole_;
    std::vector<uint16_t> seen_; // commands of examined records
    uint64_t totalBytes_ = 0;
    std::vector<uint32_t> long_; // starts of records longer than kMaxShortRecordBytes
    // State of the current comparison.
    size_t record_ = 0; // index of the next record in starts_
    size_t range_ = 0, doneBytes_ = 0, sameAt_ = 0, seenAt_ = 0, tracked_ = 0;
    uint64_t at_ = 0;
};

} // namespace mural::filter
