#include "holding/frame_layout.hpp"

#include <algorithm>

#include "streamcodec/record.hpp"

namespace mural::holding {
namespace {

uint32_t word(const std::byte* from) {
    uint32_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return value;
}

uint64_t twoWords(const std::byte* from) {
    uint64_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return value;
}

// How many of them are equal, in whole words. Multiples of 4 bytes; most are one word or a few.
inline size_t equalBytes(const std::byte* a, const std::byte* b, size_t sizeBytes) {
    size_t at = 0;
    for (; sizeBytes - at >= 8; at += 8)
        if (twoWords(a + at) != twoWords(b + at)) break;
    while (at < sizeBytes && word(a + at) == word(b + at)) at += 4;
    return at;
}

inline bool equal(const std::byte* a, const std::byte* b, size_t sizeBytes) {
    for (; sizeBytes >= 8; sizeBytes -= 8, a += 8, b += 8)
        if (twoWords(a) != twoWords(b)) return false;
    return sizeBytes == 0 || word(a) == word(b);
}

} // namespace

void FrameLayout::clear() {
    ranges_.clear();
    same_.clear();
    starts_.clear();
    whole_.clear();
    seen_.clear();
    totalBytes_ = longestBytes_ = 0;
    begin();
}

void FrameLayout::begin() {
    record_ = range_ = doneBytes_ = sameAt_ = seenAt_ = followed_ = 0;
    at_ = 0;
}

bool FrameLayout::add(Same same, std::span<const std::byte> record) {
    if (ranges_.empty() || ranges_.back().otherBytes != 0) ranges_.emplace_back();
    Range& range = ranges_.back();
    const uint32_t head = word(record.data());
    if (same == Same::Seen) {
        range.otherBytes = kSeen;
        seen_.push_back(static_cast<uint16_t>(head));
        return seen_.size() <= kMostRecords;
    }
    const size_t sameBytes = same == Same::All ? record.size() : head >> 16 == record::kLongForm ? 8 : 4;
    const auto at = static_cast<uint32_t>(totalBytes_);
    starts_.push_back(at);
    if (same == Same::All) whole_.push_back({at, static_cast<uint32_t>(same_.size()), static_cast<uint32_t>(record.size())});
    for (size_t i = 0; i < sameBytes; i += 4) same_.push_back(word(record.data() + i));
    range.sameBytes += static_cast<uint32_t>(sameBytes);
    range.otherBytes = static_cast<uint32_t>(record.size() - sameBytes);
    totalBytes_ += record.size();
    longestBytes_ = std::max(longestBytes_, record.size());
    return starts_.size() <= kMostRecords && same_.size() * 4 <= kMostSameBytes && totalBytes_ < kSeen;
}

// On as far as the packet is like the frame, and which records that were.
FrameLayout::Stop FrameLayout::pass(std::span<const std::byte> packet, size_t& at, Walked& walked) {
    const Stop stop = passTo(packet, at);
    const auto record = static_cast<size_t>(std::ranges::lower_bound(starts_, at_) - starts_.begin());
    if (record > record_) walked = {record - record_, static_cast<size_t>(at_ - starts_[record - 1]), longestBytes_};
    record_ = record;
    return stop;
}

FrameLayout::Stop FrameLayout::passTo(std::span<const std::byte> packet, size_t& at) {
    passWhole(packet, at);
    if (atEnd()) return Stop::End;
    const Range range = ranges_[range_];
    const size_t left = packet.size() - at, wanted = range.sameBytes - doneBytes_, compared = std::min(wanted, left);
    const size_t alike = equalBytes(packet.data() + at, sameFrom(sameAt_), compared);
    if (alike == compared && wanted <= left && range.otherBytes == kSeen) {
        go(alike, at);
        return Stop::Seen;
    }
    if (alike == compared && wanted > left) {
        go(alike, at);
        return Stop::PacketEnds;
    }
    // A record is another one, or longer than the packet.
    backToRecord(at_ + alike - (alike == compared && alike > 0 ? 4 : 0), at);
    return Stop::Differs;
}

// So many bytes of the range are as expected.
void FrameLayout::go(size_t sizeBytes, size_t& at) {
    at += sizeBytes;
    at_ += sizeBytes;
    sameAt_ += sizeBytes;
    doneBytes_ += sizeBytes;
}

// On over ranges that are, as far as they are whole: all that a loop over thousands of them needs is in registers.
void FrameLayout::passWhole(std::span<const std::byte> packet, size_t& at) {
    const std::byte* const from = packet.data() + at;
    const std::byte* const end = packet.data() + packet.size();
    const std::byte* now = from;
    const std::byte* const allSame = sameFrom(0);
    const std::byte* same = allSame + sameAt_;
    size_t done = doneBytes_;
    const Range* range = ranges_.data() + range_;
    const Range* const last = ranges_.data() + ranges_.size();
    for (; range != last; ++range, done = 0) {
        const size_t wanted = range->sameBytes - done, whole = wanted + range->otherBytes;
        if (range->otherBytes == kSeen || whole > static_cast<size_t>(end - now) || !equal(now, same, wanted)) break;
        now += whole;
        same += wanted;
    }
    range_ = static_cast<size_t>(range - ranges_.data());
    doneBytes_ = done;
    sameAt_ = static_cast<size_t>(same - allSame);
    at += static_cast<size_t>(now - from);
    at_ += static_cast<size_t>(now - from);
}

bool FrameLayout::passSeen(uint16_t opcode) {
    if (atEnd() || ranges_[range_].otherBytes != kSeen || doneBytes_ != ranges_[range_].sameBytes || seen_[seenAt_] != opcode) return false;
    ++seenAt_;
    ++range_;
    doneBytes_ = 0;
    return true;
}

size_t FrameLayout::passed() const {
    if (atEnd() || followed_ == whole_.size() || whole_[followed_].at >= at_) return atEnd() ? whole_.size() : followed_;
    return static_cast<size_t>(std::ranges::lower_bound(whole_, at_, {}, &Whole::at) - whole_.begin());
}

// To the record in which the packet is another one.
void FrameLayout::backToRecord(uint64_t differsAt, size_t& at) {
    const uint64_t start = *(std::ranges::upper_bound(starts_, differsAt) - 1);
    if (start >= at_) at += start - at_; // records before it are the same
    else at -= std::min<uint64_t>(at_ - start, at); // more only in a packet that is damaged
    at_ = start;
}

} // namespace mural::holding
