// Plans retransmissions. A group of datagrams receives as many new parity symbols as its member with the most losses
// lacks, once: one parity symbol repairs different losses of different members.
//
// Feedback is as old as the newest datagram the member had received (its echo). Parity sent later may be in flight and
// is taken into account, so repeated requests cause no superfluous parity. When the parity symbols of a group are used
// up, the datagrams themselves are retransmitted.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "transport/rsp/protocol/send_window.hpp"

namespace mural::rsp {

class RetransmitPlanner {
public:
    explicit RetransmitPlanner(uint32_t windowDatagrams);

    // The group's first datagram is sent. No other group of the window has its index.
    void begin(Sequence base);
    // Reports one member's losses in a closed group. `missing`: bits from the group's base on.
    void want(const SendWindow::Group& group, uint32_t missing, int symbolsHeld, uint32_t echoUs);
    // The same, with retransmission of the datagrams.
    void wantAgain(const SendWindow::Group& group, uint32_t missing, uint32_t echoUs);
    // Schedules parity in advance, without a request.
    void wantAhead(const SendWindow::Group& group, int rows);

    struct Repair {
        Sequence base; // of the group
        bool resend = false;
        uint8_t index = 0; // retransmission: index in the group; otherwise index of the parity symbol
        uint8_t rowsSent = 0;
    };
    [[nodiscard]] bool empty() const { return queue_.empty(); }
    // Returns the next repair, which counts as sent at sentUs. Drops groups before `oldest`. The group `partial` is not
    // sent completely: its repairs wait, unless the rest may not be sent (`blocked`); then its datagrams are
    // retransmitted.
    std::optional<Repair> take(Sequence oldest, std::optional<Sequence> partial, bool blocked, uint32_t sentUs);

    [[nodiscard]] int rowsSent(Sequence base) const;
    [[nodiscard]] int rowsAhead(Sequence base) const;
    // Returns the number of parity symbols the group needed beyond those sent in advance.
    [[nodiscard]] int rowsNeeded(Sequence base) const;

private:
    static constexpr int kTimes = 16;
    struct State {
        Sequence base;
        bool queued = false;
        uint8_t rowsSent = 0;
        uint8_t rowsWanted = 0;
        uint8_t rowsAhead = 0;
        uint32_t missing = 0;  // at any member, as reported
        uint32_t resend = 0;   // datagrams to retransmit
        uint32_t resentUs = 0; // time of the last retransmission
        bool hasResent = false;
        std::array<uint32_t, kTimes> sentUs{}; // parity symbol r at r % kTimes
    };
    [[nodiscard]] const State* find(Sequence base) const;
    [[nodiscard]] static int rowsSentBy(const State& s, uint32_t us);
    void enqueue(State& s);
    std::optional<Repair> takeFrom(State& s, uint32_t sentUs);

    uint32_t mask_;
    std::vector<State> states_; // indexed by the group's first datagram
    // Groups with pending repairs, oldest first: they block readers and the window longest. With a FIFO queue, a member
    // with burst losses waited for all other requests: 2 s for bursts of 0.2 s.
    std::vector<Sequence> queue_;
};

} // namespace mural::rsp
