// What a reader has of a stream: payloads in a ring, what is missing between them, and the parity that came. Groups that
// can be completed from their parity are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "transport/rsp/datagram.hpp"
#include "transport/rsp/keys.hpp"
#include "transport/rsp/landing.hpp"
#include "transport/rsp/payload_places.hpp"
#include "transport/rsp/send_window.hpp"

namespace mural::rsp {

struct ReceiveCounters {
    uint64_t datagrams = 0; // new ones, of any kind
    uint64_t duplicates = 0;
    uint64_t outside = 0;   // of the window
    uint64_t recovered = 0; // datagrams made from parity
    uint64_t refused = 0;   // what contradicts what came before, or itself
};

class ReceiveWindow {
public:
    ReceiveWindow(const StreamShape& shape, Sequence first);

    // Places for the next datagrams, until the next call: a payload that lies there behind its head is taken as it lies.
    Landing landing();

    enum class Took { New, Known, Refused };
    Took takeData(const StreamDatagram& d);
    Took takeParity(const StreamDatagram& d);
    // The group that begins there has so many datagrams: told by a poll.
    void learnGroupSize(Sequence base, uint8_t size);

    // All before it are here.
    [[nodiscard]] Sequence cumulative() const { return cumulative_; }
    [[nodiscard]] bool has(Sequence s) const { return s < cumulative_ || (inWindow(s) && lengths_[slot(s)] != 0); }
    // The next bytes, of one datagram; empty when they are not here.
    [[nodiscard]] std::span<const std::byte> readable() const;
    // All that are in order, a piece for each datagram, as many as `into` takes; returns how many.
    size_t readable(std::span<std::span<const std::byte>> into) const;
    // So many of them are done with.
    void consume(size_t bytes);
    // The first datagram of which bytes are still to be read or kept: windowDatagrams from here on have a place.
    [[nodiscard]] Sequence oldest() const;

    // What is missing from `from` on and before `until`, at most one group's worth; span 0: nothing.
    [[nodiscard]] Missing missingFrom(Sequence from, Sequence until) const;

    [[nodiscard]] const ReceiveCounters& counters() const { return counters_; }

private:
    struct Row {
        uint8_t row;
        std::vector<std::byte> symbol;
    };
    struct Group {
        Sequence base;
        uint8_t size = 0;  // 0: not known
        uint32_t have = 0; // bit i: base + i is here
        std::vector<Row> rows;
        [[nodiscard]] uint32_t missing() const { return (size == kMostInGroup ? ~0u : (1u << size) - 1) & ~have; }
        [[nodiscard]] bool complete() const { return size != 0 && missing() == 0; }
    };
    [[nodiscard]] size_t slot(Sequence s) const { return s.value() & mask_; }
    [[nodiscard]] bool inWindow(Sequence s) const { return s >= forgotten_ && s - forgotten_ <= mask_; }
    Group* groupAt(Sequence base);
    [[nodiscard]] const Group* findGroup(Sequence s) const;
    bool learnSize(Group& g, uint8_t size);
    void store(Group& g, Sequence s, std::span<const std::byte> payload);
    uint32_t placeFor(std::span<const std::byte> payload);
    void tryToComplete(Group& g);
    void recover(Group& g, std::span<const int> missing);
    bool addPresent(const Group& g, Row& row) const;
    bool takeSymbol(Group& g, int index, std::span<const std::byte> symbol);
    void dropRows(Group& g);
    void advance();
    void forget();
    void forgetDatagram(size_t at);
    [[nodiscard]] std::span<const std::byte> payload(Sequence s) const { return {payloads_.at(places_[slot(s)]) + kStreamHeadBytes, lengths_[slot(s)]}; }

    size_t payloadBytes_;
    uint32_t mask_;
    PayloadPlaces payloads_;
    std::array<uint32_t, kMostAtOnce> landing_{};        // places where datagrams may come; kNoPlace: one is here
    std::array<std::byte*, kMostAtOnce> landingBytes_{}; // of each
    size_t landed_ = 0;                    // behind the last of them that is here
    std::vector<uint32_t> places_;     // of payloads, of datagrams that are here
    std::vector<uint16_t> lengths_;    // 0: not here
    std::vector<Sequence> groupBases_; // by datagram, of those that are here
    std::vector<Group> groups_;        // by the group's first datagram
    std::vector<bool> known_;          // of groups_, side by side: most begin no group
    std::vector<std::byte> scratch_;
    Sequence cumulative_;
    Sequence reading_;     // the datagram that is being read
    size_t readBytes_ = 0; // of it
    Sequence forgotten_;   // slots before it are free
    size_t rowsHeld_ = 0;
    ReceiveCounters counters_;
};

} // namespace mural::rsp
