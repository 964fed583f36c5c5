// A writer's window: unacknowledged payloads in a ring, in groups for the erasure code. A group closes when it is full
// or the stream is flushed, so the end of a frame does not wait for more data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "transport/rsp/wire/datagram.hpp"

namespace mural::rsp {

struct StreamShape {
    size_t payloadBytes = 1430;      // of a full datagram
    uint32_t windowDatagrams = 4096; // a power of two, 64 to 2^16
};

class SendWindow {
public:
    SendWindow(const StreamShape& shape, Sequence first);

    // Copies as much as there is room for; returns the number of bytes.
    size_t write(std::span<const std::byte> bytes);
    // Closes the open datagram and the open group.
    void flush();
    // Closes the open group: it needs a repair, and no more data follows.
    void closeGroup();

    [[nodiscard]] Sequence base() const { return base_; }     // oldest retained datagram
    [[nodiscard]] Sequence filled() const { return filled_; } // one past the newest complete datagram
    [[nodiscard]] bool empty() const { return base_ == filled_ && openBytes_ == 0; }
    [[nodiscard]] size_t roomBytes() const;
    [[nodiscard]] std::span<const std::byte> payload(Sequence s) const;

    struct Group {
        Sequence base;
        uint8_t size = 0;   // 0: open
        uint8_t filled = 0; // datagrams so far
    };
    // Returns the group of a datagram within base() .. filled().
    [[nodiscard]] Group groupOf(Sequence s) const;
    // Returns the newest group with a datagram; `filled` is 0 if there is none.
    [[nodiscard]] Group newestGroup() const;

    // All members have received everything before `until`. A group is retained until its last datagram is acknowledged,
    // for its parity.
    void release(Sequence until);

private:
    [[nodiscard]] size_t slot(Sequence s) const { return s.value() & mask_; }
    void closeDatagram();

    size_t payloadBytes_;
    uint32_t mask_;
    // Contiguous payloads of payloadBytes_ each. Uninitialised: an idle stream commits no memory.
    std::unique_ptr<std::byte[]> payloads_;
    std::vector<uint16_t> lengths_;
    std::vector<Sequence> groupBases_; // per datagram
    std::vector<uint8_t> groupSizes_;  // indexed by the group's first datagram
    Sequence base_;
    Sequence filled_;
    Sequence groupBase_; // of the open group, or of the next one
    size_t openBytes_ = 0;
};

} // namespace mural::rsp
