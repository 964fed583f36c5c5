// What a writer has not yet been told to have arrived everywhere: payloads of datagrams in a ring, cut into groups for
// the erasure code. A group is closed when it is full or the stream is flushed, so that a frame's end waits for no more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "transport/rsp/datagram.hpp"

namespace mural::rsp {

struct StreamShape {
    size_t payloadBytes = 1430;      // of a full datagram
    uint32_t windowDatagrams = 4096; // a power of two, 64 to 2^16
};

class SendWindow {
public:
    SendWindow(const StreamShape& shape, Sequence first);

    // Copies as much as there is room for; returns how much that was.
    size_t write(std::span<const std::byte> bytes);
    // Ends the open datagram and the open group.
    void flush();
    // Ends the open group alone: a repair of it is wanted, and no more data is there.
    void closeGroup();

    [[nodiscard]] Sequence base() const { return base_; }     // the oldest that is kept
    [[nodiscard]] Sequence filled() const { return filled_; } // behind the newest that is complete
    [[nodiscard]] bool empty() const { return base_ == filled_ && openBytes_ == 0; }
    [[nodiscard]] size_t roomBytes() const;
    [[nodiscard]] std::span<const std::byte> payload(Sequence s) const;

    struct Group {
        Sequence base;
        uint8_t size = 0;   // 0: open
        uint8_t filled = 0; // datagrams so far
    };
    // Of a datagram within base() .. filled().
    [[nodiscard]] Group groupOf(Sequence s) const;
    // The newest group that has a datagram; filled is 0 when there is none yet.
    [[nodiscard]] Group newestGroup() const;

    // All before `until` are everywhere. Their group is kept whole until its last one is, for its parity.
    void release(Sequence until);

private:
    [[nodiscard]] size_t slot(Sequence s) const { return s.value() & mask_; }
    void closeDatagram();

    size_t payloadBytes_;
    uint32_t mask_;
    // One after the other, payloadBytes_ each. Not filled with zeros: a stream that carries nothing takes no memory.
    std::unique_ptr<std::byte[]> payloads_;
    std::vector<uint16_t> lengths_;
    std::vector<Sequence> groupBases_; // by datagram
    std::vector<uint8_t> groupSizes_;  // by the group's first datagram
    Sequence base_;
    Sequence filled_;
    Sequence groupBase_; // of the open group, or where the next one begins
    size_t openBytes_ = 0;
};

} // namespace mural::rsp
