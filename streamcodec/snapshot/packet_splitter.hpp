// Assembles records into packets: consecutive records of one stream, up to the packet size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::snapshot {

class PacketSplitter {
public:
    using Take = std::function<void(uint32_t stream, std::span<const std::byte> payload)>;
    explicit PacketSplitter(Take take) : take_(std::move(take)) {}

    void add(uint32_t stream, std::span<const std::byte> records) {
        if (stream != stream_) flush();
        stream_ = stream;
        wire::RecordWalk walk(records);
        wire::RecordView r;
        while (walk.next(r)) {
            if (payload_.size() + r.sizeBytes > kWantedBytes) flush();
            const auto record = records.subspan(r.offset, r.sizeBytes);
            payload_.insert(payload_.end(), record.begin(), record.end());
        }
    }
    void flush() {
        if (!payload_.empty()) take_(stream_, payload_);
        payload_.clear();
    }

private:
    // size of the program's own packets; a record may be larger
    static constexpr size_t kWantedBytes = wire::kMaxPacketBytes / 4;
    Take take_;
    uint32_t stream_ = 0;
    std::vector<std::byte> payload_;
};

} // namespace mural::snapshot
