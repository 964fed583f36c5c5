// A barrier between processes: all members of a round continue together. State machines without sockets, clocks and
// threads. The leader is the session's head, so the loss of a member never loses the barrier.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "objects/core/blob_intake.hpp"
#include "objects/core/message_sink.hpp"

namespace mural::objects {

// Counts rounds and releases the members.
//
// Thread safety: none.
class ObjectBarrierLeader {
public:
    ObjectBarrierLeader(MessageSink& sink, uint32_t barrier) : sender_(sink), barrier_(barrier) {}

    void join(PeerId member, const std::string& name);
    // A member is lost or leaves. The others no longer wait for it.
    void leave(PeerId member);
    Result<void> input(PeerId member, const EnterMessage& message, int64_t nowNs);
    // Sends the names of the missing members to those whose patience has ended. These leave the round.
    void tick(int64_t nowNs);

    [[nodiscard]] uint64_t round() const { return round_; } // open round, from 1 on
    // Returns the names of the members that have not entered, separated by commas.
    [[nodiscard]] std::string missing() const;

private:
    struct Member {
        std::string name;
        bool hasEntered = false;
        int64_t deadlineNs = INT64_MAX;
    };
    void releaseIfComplete();

    MessageSender sender_;
    const uint32_t barrier_;
    std::map<PeerId, Member> members_;
    uint64_t round_ = 1;
};

// A member's side.
class ObjectBarrierMember {
public:
    ObjectBarrierMember(MessageSink& sink, uint32_t barrier) : sender_(sink), barrier_(barrier) {}

    // Enters the next round. `patienceMs`: time after which the leader names the missing members; 0: none.
    void enter(uint32_t patienceMs);
    void input(const GoMessage& message);
    void input(const LateMessage& message);

    // Returns the result of enter(): the number of members that entered, or an error that names the missing ones.
    // Empty: still waiting.
    [[nodiscard]] std::optional<Result<uint32_t>> result() const;

private:
    MessageSender sender_;
    const uint32_t barrier_;
    uint64_t round_ = 0; // last released round
    bool isWaiting_ = false;
    std::optional<Result<uint32_t>> result_;
};

} // namespace mural::objects
