// Pending blobs of one stream, which precede their record (docs/reference/wire-format.md).
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/args.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::trace {

class StreamBlobs : public BlobQueue {
public:
    // Returns true if the record was a part of a blob, and false, with malformed(), if it was invalid.
    bool take(const wire::RecordView& r) {
        taken_.clear();
        Args in(r.arguments, *this);
        if (r.opcode == wire::kOpBlobBegin) {
            missing_ = in.get<uint64_t>();
            malformed_ = !in.ok() || blobs_.size() >= kMaxBlobs;
            if (!malformed_) blobs_.emplace_back();
            return !malformed_;
        }
        if (r.opcode != wire::kOpBlobData) return false;
        const auto n = in.get<uint32_t>();
        const auto* bytes = in.fixed<std::byte>(n);
        malformed_ = !in.ok() || blobs_.empty() || n > missing_;
        if (malformed_) return false;
        blobs_.back().insert(blobs_.back().end(), bytes, bytes + n);
        missing_ -= n;
        return true;
    }
    [[nodiscard]] bool malformed() const { return malformed_; }

    std::span<const std::byte> takeBlob(bool& found) override {
        found = !blobs_.empty() && (blobs_.size() > 1 || missing_ == 0);
        if (!found) return {};
        taken_.push_back(std::move(blobs_.front())); // valid until the next record
        blobs_.pop_front();
        return taken_.back();
    }

private:
    static constexpr size_t kMaxBlobs = 256; // limit of the nodes
    std::deque<std::vector<std::byte>> blobs_;
    std::deque<std::vector<std::byte>> taken_;
    uint64_t missing_ = 0; // of the last blob
    bool malformed_ = false;
};

} // namespace mural::trace
