#include "streamcodec/filter/frame_template.hpp"

#include <algorithm>

#include "streamcodec/wire/record.hpp"

namespace mural::filter {
namespace {

uint32_t word(const std::byte* from) {
    uint32_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return value;
}

// Compares masked words with baseline vector instructions.
using Vector = uint32_t __attribute__((vector_size(16)));
constexpr size_t kBlockWords = 16, kVectorWords = sizeof(Vector) / sizeof(uint32_t);

inline Vector vectorAt(const void* from) {
    Vector v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

inline bool isOther(const std::byte* now, const uint32_t* same, const uint32_t* matters) {
    Vector other{};
    for (size_t i = 0; i < kBlockWords; i += kVectorWords)
        other |= (vectorAt(now + i * 4) ^ vectorAt(same + i)) & vectorAt(matters + i);
    return (other[0] | other[1] | other[2] | other[3]) != 0;
}

} // namespace

void FrameTemplate::clear() {
    ranges_.clear();
    same_.clear();
    matters_.clear();
    starts_.clear();
    whole_.clear();
    seen_.clear();
    long_.clear();
    totalBytes_ = 0;
    begin();
}

void FrameTemplate::begin() {
    record_ = range_ = doneBytes_ = sameAt_ = seenAt_ = tracked_ = 0;
    at_ = 0;
}

bool FrameTemplate::add(Same same, std::span<const std::byte> record) {
    if (ranges_.empty() || ranges_.back().otherBytes != 0) ranges_.emplace_back();
    Range& range = ranges_.back();
    const uint32_t head = word(record.data());
    if (same == Same::Seen) {
        range.otherBytes = kSeen;
        seen_.push_back(static_cast<uint16_t>(head));
        return seen_.size() <= kMaxRecords;
    }
    const size_t headBytes = record::headerBytesOf(head);
    const size_t matterBytes = same == Same::All ? record.size() : headBytes;
    const size_t sameBytes = record.size() - matterBytes <= kShortBytes ? record.size() : matterBytes;
    const auto at = static_cast<uint32_t>(totalBytes_);
    starts_.push_back(at);
    if (same == Same::All)
        whole_.push_back({at, static_cast<uint32_t>(same_.size()), static_cast<uint32_t>(record.size())});
    keep(record.data(), matterBytes, ~0U);
    keep(record.data() + matterBytes, sameBytes - matterBytes, 0);
    range.sameBytes += static_cast<uint32_t>(sameBytes);
    range.otherBytes = static_cast<uint32_t>(record.size() - sameBytes);
    totalBytes_ += record.size();
    if (record.size() > kMaxShortRecordBytes) long_.push_back(at);
    return starts_.size() <= kMaxRecords && same_.size() * 4 <= kMaxSameBytes && totalBytes_ < kSeen;
}

void FrameTemplate::keep(const std::byte* record, size_t sizeBytes, uint32_t matters) {
    for (size_t i = 0; i < sizeBytes; i += 4) {
        same_.push_back(word(record + i));
        matters_.push_back(matters);
    }
}

size_t FrameTemplate::likeBytes(const std::byte* packet, size_t sameAt, size_t sizeBytes) const {
    const uint32_t *const same = same_.data() + sameAt / 4, *const matters = matters_.data() + sameAt / 4;
    const size_t words = sizeBytes / 4;
    size_t i = 0;
    while (words - i >= kBlockWords && !isOther(packet + i * 4, same + i, matters + i)) i += kBlockWords;
    while (i < words && ((word(packet + i * 4) ^ same[i]) & matters[i]) == 0) ++i;
    return i * 4;
}

// Advances while the packet matches the template, and collects the record offsets.
FrameTemplate::Stop FrameTemplate::pass(std::span<const std::byte> packet, size_t& at, RecordOffsets& walked) {
    const size_t packetFrom = at;
    const uint64_t from = at_;
    const Stop stop = passTo(packet, at);
    const auto record = static_cast<size_t>(std::ranges::lower_bound(starts_, at_) - starts_.begin());
    if (record > record_) {
        walked = {record - record_, static_cast<size_t>(at_ - starts_[record - 1]), {}};
        for (auto next = std::ranges::lower_bound(long_, from); next != long_.end() && *next < at_; ++next)
            walked.longAt.push_back(static_cast<uint32_t>(packetFrom + (*next - from)));
    }
    record_ = record;
    return stop;
}

FrameTemplate::Stop FrameTemplate::passTo(std::span<const std::byte> packet, size_t& at) {
    passWhole(packet, at);
    if (atEnd()) return Stop::End;
    const Range range = ranges_[range_];
    const size_t left = packet.size() - at, wanted = range.sameBytes - doneBytes_, compared = std::min(wanted, left);
    const size_t alike = likeBytes(packet.data() + at, sameAt_, compared);
    if (alike == compared && wanted <= left && range.otherBytes == kSeen) {
        go(alike, at);
        return Stop::Seen;
    }
    if (alike == compared && wanted > left) {
        go(alike, at);
        return Stop::PacketEnds;
    }
    // A record differs, or extends beyond the packet.
    backToRecord(at_ + alike - (alike == compared && alike > 0 ? 4 : 0), at);
    return Stop::Differs;
}

// Advances by matching bytes of the range.
void FrameTemplate::go(size_t sizeBytes, size_t& at) {
    at += sizeBytes;
    at_ += sizeBytes;
    sameAt_ += sizeBytes;
    doneBytes_ += sizeBytes;
}

// Advances over whole matching ranges. A separate loop, which keeps its state in registers for thousands of ranges.
void FrameTemplate::passWhole(std::span<const std::byte> packet, size_t& at) {
    const std::byte* const from = packet.data() + at;
    const std::byte* const end = packet.data() + packet.size();
    const std::byte* now = from;
    size_t same = sameAt_;
    size_t done = doneBytes_;
    const Range* range = ranges_.data() + range_;
    const Range* const last = ranges_.data() + ranges_.size();
    for (; range != last; ++range, done = 0) {
        const size_t wanted = range->sameBytes - done, whole = wanted + range->otherBytes;
        if (range->otherBytes == kSeen || whole > static_cast<size_t>(end - now) ||
            likeBytes(now, same, wanted) < wanted)
            break;
        now += whole;
        same += wanted;
    }
    range_ = static_cast<size_t>(range - ranges_.data());
    doneBytes_ = done;
    sameAt_ = same;
    at += static_cast<size_t>(now - from);
    at_ += static_cast<size_t>(now - from);
}

bool FrameTemplate::passSeen(uint16_t opcode) {
    if (atEnd() || ranges_[range_].otherBytes != kSeen || doneBytes_ != ranges_[range_].sameBytes ||
        seen_[seenAt_] != opcode)
        return false;
    ++seenAt_;
    ++range_;
    doneBytes_ = 0;
    return true;
}

size_t FrameTemplate::passed() const {
    if (atEnd() || tracked_ == whole_.size() || whole_[tracked_].at >= at_) return atEnd() ? whole_.size() : tracked_;
    return static_cast<size_t>(std::ranges::lower_bound(whole_, at_, {}, &Whole::at) - whole_.begin());
}

// Returns to the start of the differing record.
void FrameTemplate::backToRecord(uint64_t differsAt, size_t& at) {
    const uint64_t start = *(std::ranges::upper_bound(starts_, differsAt) - 1);
    if (start >= at_)
        at += start - at_; // earlier records match
    else
        at -= std::min<uint64_t>(at_ - start, at); // exceeded only by a damaged packet
    at_ = start;
}

} // namespace mural::filter
