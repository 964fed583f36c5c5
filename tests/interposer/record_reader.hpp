// Splits a stream as the replay does: reads records one by one and joins blobs.
#pragma once

#include <cstring>
#include <deque>
#include <span>
#include <vector>

#include "streamcodec/wire/args.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::testing {

struct ReadRecord {
    uint16_t opcode = 0;
    bool longForm = false;
    std::span<const std::byte> arguments;
};

class RecordReader : public BlobQueue {
public:
    explicit RecordReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    // Reads the next record that is not a blob. Returns false at the end or, if broken(), at an invalid record.
    bool next(ReadRecord& r) {
        while (cut(r)) {
            Args in(r.arguments, *this);
            if (r.opcode == wire::kOpBlobBegin) {
                blobs_.emplace_back();
                missing_ = in.get<uint64_t>();
                ++blobCount_;
            } else if (r.opcode == wire::kOpBlobData) {
                const auto n = in.get<uint32_t>();
                const auto* p = in.fixed<std::byte>(n);
                broken_ = broken_ || !in.ok() || blobs_.empty() || n > missing_;
                if (broken_) return false;
                blobs_.back().insert(blobs_.back().end(), p, p + n);
                missing_ -= n;
            } else {
                return true;
            }
        }
        return false;
    }
    [[nodiscard]] bool broken() const { return broken_ || missing_ > 0; }
    [[nodiscard]] size_t blobCount() const { return blobCount_; }
    [[nodiscard]] size_t blobsLeft() const { return blobs_.size(); }

    std::span<const std::byte> takeBlob(bool& found) override {
        found = !blobs_.empty();
        if (!found) return {};
        taken_.push_back(std::move(blobs_.front()));
        blobs_.pop_front();
        return taken_.back();
    }

private:
    bool cut(ReadRecord& r) {
        if (rest_.size() < 4) {
            broken_ = broken_ || !rest_.empty();
            return false;
        }
        uint32_t words[2] = {};
        std::memcpy(words, rest_.data(), rest_.size() < 8 ? 4 : 8);
        r.opcode = static_cast<uint16_t>(words[0] & 0xffff);
        r.longForm = record::isLongForm(words[0]);
        const size_t bytes = 4 * size_t{r.longForm ? words[1] : words[0] >> 16}, head = r.longForm ? 8 : 4;
        if (bytes < head || bytes > rest_.size()) {
            broken_ = true;
            return false;
        }
        r.arguments = rest_.subspan(head, bytes - head);
        rest_ = rest_.subspan(bytes);
        return true;
    }

    std::span<const std::byte> rest_;
    std::deque<std::vector<std::byte>> blobs_, taken_;
    uint64_t missing_ = 0;
    size_t blobCount_ = 0;
    bool broken_ = false;
};

} // namespace mural::testing
