// Where the records of a frame lie, and what of their bytes says what they bind. The next frame is compared with it at those places, so
// that no record has to be read before the one behind it is found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "streamcodec/walked.hpp"

namespace mural::holding {

// How much of a record has to be the same.
enum class Same : uint8_t {
    Head, // its command and its length
    All,
    Seen, // only its command: somebody looks at it each time, however long it is
};

class FrameLayout {
public:
    void clear();
    // The next record of the frame; false: there are too many.
    bool add(Same same, std::span<const std::byte> record);

    // From the first record on.
    void begin();
    enum class Stop : uint8_t { PacketEnds, Seen, Differs, End };
    // On as far as the packet is like the frame, from a record at `at`; where that is then a record begins again.
    Stop pass(std::span<const std::byte> packet, size_t& at, Walked& walked);
    // The record that stopped it has been looked at; false: it is another one.
    bool passSeen(uint16_t opcode);
    [[nodiscard]] bool atEnd() const { return range_ == ranges_.size(); }
    [[nodiscard]] double share() const { return totalBytes_ == 0 ? 0 : static_cast<double>(at_) / static_cast<double>(totalBytes_); } // that has been passed
    [[nodiscard]] bool empty() const { return ranges_.empty(); }
    // Those of Same::All that were passed are given, from the first that has not been; these are counted.
    [[nodiscard]] size_t passed() const;
    [[nodiscard]] size_t followed() const { return followed_; }
    template <typename Give>
    void follow(size_t to, const Give& give) {
        for (; followed_ < to; ++followed_) give(std::as_bytes(std::span(same_)).subspan(whole_[followed_].sameAt * size_t{4}, whole_[followed_].sizeBytes));
    }
    void followFrom(size_t count) { followed_ = count; } // those before have been given otherwise

private:
    static constexpr uint32_t kSeen = UINT32_MAX;
    static constexpr size_t kMostRecords = size_t{1} << 18, kMostSameBytes = size_t{8} << 20;
    static constexpr size_t kShortBytes = 256; // so many that do not matter are looked at all the same: to go around them takes longer
    struct Range {
        uint32_t sameBytes = 0;
        uint32_t otherBytes = 0; // behind them; kSeen: a record that is looked at
    };
    struct Whole {
        uint32_t at = 0, sameAt = 0 /* words */, sizeBytes = 0;
    };
    void keep(const std::byte* record, size_t sizeBytes, uint32_t matters);
    // From there on, how many bytes of the packet are as expected where that matters, in whole words.
    [[nodiscard]] size_t likeBytes(const std::byte* packet, size_t sameAt, size_t sizeBytes) const;
    Stop passTo(std::span<const std::byte> packet, size_t& at);
    void passWhole(std::span<const std::byte> packet, size_t& at);
    void go(size_t sizeBytes, size_t& at);
    void backToRecord(uint64_t differsAt, size_t& at);

    // Places count all bytes but those of records that are looked at.
    std::vector<Range> ranges_;
    std::vector<uint32_t> same_; // what has to be, one behind the other; of short records what need not be, too
    std::vector<uint32_t> matters_; // of these the bits that do
    std::vector<uint32_t> starts_;
    std::vector<Whole> whole_;
    std::vector<uint16_t> seen_; // their commands
    uint64_t totalBytes_ = 0;
    std::vector<uint32_t> long_; // where records longer than kMostShortRecordBytes begin
    // The frame that comes.
    size_t record_ = 0; // in starts_, the next one
    size_t range_ = 0, doneBytes_ = 0, sameAt_ = 0, seenAt_ = 0, followed_ = 0;
    uint64_t at_ = 0;
};

} // namespace mural::holding
