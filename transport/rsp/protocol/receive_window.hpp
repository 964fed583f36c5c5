// A reader's window of a stream: payloads in a ring, gaps between them, and received parity. Restores groups from
// parity where possible.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "transport/rsp/wire/datagram.hpp"
#include "transport/rsp/wire/keys.hpp"
#include "transport/rsp/protocol/receive_buffers.hpp"
#include "transport/rsp/protocol/slot_pool.hpp"
#include "transport/rsp/protocol/send_window.hpp"

namespace mural::rsp {

struct ReceiveCounters {
    uint64_t datagrams = 0; // new datagrams of any type
    uint64_t duplicates = 0;
    uint64_t outside = 0;   // outside of the window
    uint64_t recovered = 0; // restored from parity
    uint64_t refused = 0;   // inconsistent with earlier data, or in itself
};

class ReceiveWindow {
public:
    ReceiveWindow(const StreamShape& shape, Sequence first);

    // Returns buffers for the next datagrams, valid until the next call. A payload received into them, after its
    // header, is not copied.
    ReceiveBuffers landing();

    enum class InsertResult { New, Known, Refused };
    InsertResult takeData(const StreamDatagram& d);
    InsertResult takeParity(const StreamDatagram& d);
    // Sets the size of the group that begins there, from a POLL.
    void updateGroupSize(Sequence base, uint8_t size);

    // Cumulative acknowledgement: everything before has been received.
    [[nodiscard]] Sequence cumulative() const { return cumulative_; }
    [[nodiscard]] bool has(Sequence s) const { return s < cumulative_ || (inWindow(s) && lengths_[slot(s)] != 0); }
    // Returns the next bytes, of one datagram; empty if they are missing.
    [[nodiscard]] std::span<const std::byte> readable() const;
    // Returns all contiguous data, one piece per datagram, up to the size of `into`; returns the number of pieces.
    size_t readable(std::span<std::span<const std::byte>> into) const;
    // Releases bytes that have been read.
    void consume(size_t bytes);
    // Returns the first datagram with unread or retained bytes. The window covers windowDatagrams from here on.
    [[nodiscard]] Sequence oldest() const;

    // Returns the missing datagrams from `from` on and before `until`, at most one group; span 0: none.
    [[nodiscard]] Missing missingFrom(Sequence from, Sequence until) const;

    [[nodiscard]] const ReceiveCounters& counters() const { return counters_; }

private:
    struct Row {
        uint8_t row;
        std::vector<std::byte> symbol;
    };
    struct Group {
        Sequence base;
        uint8_t size = 0;  // 0: unknown
        uint32_t have = 0; // bit i: base + i has been received
        std::vector<Row> rows;
        [[nodiscard]] uint32_t missing() const { return (size == kMaxInGroup ? ~0u : (1u << size) - 1) & ~have; }
        [[nodiscard]] bool complete() const { return size != 0 && missing() == 0; }
    };
    [[nodiscard]] size_t slot(Sequence s) const { return s.value() & mask_; }
    [[nodiscard]] bool inWindow(Sequence s) const { return s >= forgotten_ && s - forgotten_ <= mask_; }
    Group* groupAt(Sequence base);
    [[nodiscard]] const Group* findGroup(Sequence s) const;
    bool setGroupSize(Group& g, uint8_t size);
    void store(Group& g, Sequence s, std::span<const std::byte> payload);
    uint32_t slotFor(std::span<const std::byte> payload);
    void tryToComplete(Group& g);
    void recover(Group& g, std::span<const int> missing);
    bool addPresent(const Group& g, Row& row) const;
    bool takeSymbol(Group& g, int index, std::span<const std::byte> symbol);
    void dropRows(Group& g);
    void advance();
    void forget();
    void forgetDatagram(size_t at);
    [[nodiscard]] std::span<const std::byte> payload(Sequence s) const {
        return {payloads_.at(poolSlots_[slot(s)]) + kStreamHeaderBytes, lengths_[slot(s)]};
    }

    size_t payloadBytes_;
    uint32_t mask_;
    SlotPool payloads_;
    std::array<uint32_t, kMaxAtOnce> landing_{};        // slots for the next datagrams; kNoSlot: occupied
    std::array<std::byte*, kMaxAtOnce> landingBytes_{}; // address of each
    size_t landed_ = 0;                                 // one past the last occupied one
    std::vector<uint32_t> poolSlots_;                   // slot per received datagram
    std::vector<uint16_t> lengths_;                     // 0: missing
    std::vector<Sequence> groupBases_;                  // per received datagram
    std::vector<Group> groups_;                         // indexed by the group's first datagram
    std::vector<bool> known_; // validity of groups_, separate because most datagrams begin no group
    std::vector<std::byte> scratch_;
    Sequence cumulative_;
    Sequence reading_;     // datagram that is being read
    size_t readBytes_ = 0; // of it
    Sequence forgotten_;   // slots before it are free
    size_t rowsHeld_ = 0;
    ReceiveCounters counters_;
};

} // namespace mural::rsp
