// A packet in transit: unchanged, or with records removed and inserted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::filter {

// walked: record offsets of an unchanged packet; otherwise null.
using Take = std::function<void(uint32_t stream, std::span<const std::byte> payload, const RecordOffsets* walked)>;

class Output {
public:
    Output(uint32_t stream, std::span<const std::byte> payload, std::vector<std::byte>& scratch, const Take& take)
        : stream_(stream), payload_(payload), scratch_(scratch), take_(take) {
        scratch_.clear();
    }

    // Removes the bytes from `from` to `to`. Requires ascending positions.
    void drop(size_t from, size_t to) {
        copyTo(from);
        copied_ = to;
    }
    // Inserts records before that byte of the packet.
    void insert(size_t before, std::span<const std::byte> records) {
        copyTo(before);
        if (records.size() < kCopiedBytes) return append(records);
        flush();
        size_t from = 0, to = 0;
        wire::RecordWalk walk(records);
        wire::RecordView r;
        while (walk.next(r)) {
            if (to - from + r.sizeBytes > kWantedBytes && to > from) {
                take_(stream_, records.subspan(from, to - from), nullptr);
                from = to;
            }
            to += r.sizeBytes;
        }
        if (to > from) take_(stream_, records.subspan(from, to - from), nullptr);
    }
    void finish(const RecordOffsets* walked = nullptr) {
        if (!touched_) {
            if (!payload_.empty()) take_(stream_, payload_, walked);
            return;
        }
        copyTo(payload_.size());
        flush();
    }
    [[nodiscard]] uint32_t stream() const { return stream_; }

private:
    static constexpr size_t kWantedBytes = 256 * 1024; // size of the program's own packets
    static constexpr size_t kCopiedBytes = 16 * 1024;  // larger parts are sent in place

    void copyTo(size_t to) {
        touched_ = true;
        if (to > copied_) append(payload_.subspan(copied_, to - copied_));
        copied_ = to;
    }
    void append(std::span<const std::byte> bytes) {
        if (scratch_.size() + bytes.size() > wire::kMaxPacketBytes || scratch_.size() >= kWantedBytes) flush();
        scratch_.insert(scratch_.end(), bytes.begin(), bytes.end());
    }
    void flush() {
        if (!scratch_.empty()) take_(stream_, scratch_, nullptr);
        scratch_.clear();
    }

    const uint32_t stream_;
    const std::span<const std::byte> payload_;
    std::vector<std::byte>& scratch_;
    const Take& take_;
    size_t copied_ = 0;
    bool touched_ = false;
};

} // namespace mural::filter
