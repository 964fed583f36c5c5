// Which repairs a writer owes. Members tell what they miss; the group gets as many new rows of parity as its neediest
// member lacks, once: a row mends different losses of different members.
//
// What a member tells is as old as the newest datagram it had seen (its echo). Rows sent after that may still be under
// way; they are taken into account, so that neither a second member's nor a repeated request makes needless rows.
// Where a group's rows are used up, the datagrams themselves are sent again.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "transport/rsp/send_window.hpp"

namespace mural::rsp {

class RepairPlan {
public:
    explicit RepairPlan(uint32_t windowDatagrams);

    // A group's first datagram goes out; the window has no other group with its place.
    void begin(Sequence base);
    // One member's losses in one group, which is closed and has begun. `missing`: bits from the group's base on.
    void want(const SendWindow::Group& group, uint32_t missing, int rowsHeld, uint32_t echoUs);
    // As want, by sending the datagrams again.
    void wantAgain(const SendWindow::Group& group, uint32_t missing, uint32_t echoUs);
    // Rows that nobody has asked for yet.
    void wantAhead(const SendWindow::Group& group, int rows);

    struct Repair {
        Sequence base; // of the group
        bool resend = false;
        uint8_t place = 0; // resend: index in the group; else the row
        uint8_t rowsSent = 0;
    };
    [[nodiscard]] bool empty() const { return queue_.empty(); }
    // The next one, which counts as sent at sentUs. Groups before `oldest` are no longer of interest. The group
    // `partial` has not been sent whole: it waits, unless the rest may not be sent (`blocked`); then its datagrams
    // are sent again.
    std::optional<Repair> take(Sequence oldest, std::optional<Sequence> partial, bool blocked, uint32_t sentUs);

    [[nodiscard]] int rowsSent(Sequence base) const;
    [[nodiscard]] int rowsAhead(Sequence base) const;
    // Rows above those sent ahead that the group has needed.
    [[nodiscard]] int rowsNeeded(Sequence base) const;

private:
    static constexpr int kTimes = 16;
    struct State {
        Sequence base;
        bool queued = false;
        uint8_t rowsSent = 0;
        uint8_t rowsWanted = 0;
        uint8_t rowsAhead = 0;
        uint32_t missing = 0;  // at any member, as was told
        uint32_t resend = 0;   // datagrams to send again
        uint32_t resentUs = 0; // when that was done last
        bool hasResent = false;
        std::array<uint32_t, kTimes> sentUs{}; // of row r at r % kTimes
    };
    [[nodiscard]] const State* find(Sequence base) const;
    [[nodiscard]] static int rowsSentBy(const State& s, uint32_t us);
    void enqueue(State& s);
    std::optional<Repair> takeFrom(State& s, uint32_t sentUs);

    uint32_t mask_;
    std::vector<State> states_;  // by the group's first datagram
    // Groups with something to send, a heap: what is oldest holds readers, and the window, most. By who asked first, one who
    // lost bursts waited for all that others had asked for meanwhile: 2 s for bursts of 0.2 s.
    std::vector<Sequence> queue_;
};

} // namespace mural::rsp
