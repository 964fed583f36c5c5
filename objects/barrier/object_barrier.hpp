// A barrier between processes: all members of a round continue together. State machines without sockets, clocks and
// threads. The leader is in the program's process, so the loss of a node never loses the barrier.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/base/result.hpp"
#include "objects/core/blob_intake.hpp"
#include "objects/core/message_sink.hpp"

namespace mural::objects {

// Releases the members of a round when all that it waits for have entered it, or a later one. Rounds are increasing
// numbers: members count them, or take them from the frames of a session.
//
// Thread safety: none.
class ObjectBarrierLeader {
public:
    ObjectBarrierLeader(MessageSink& sink, uint32_t barrier) : sender_(sink), barrier_(barrier) {}

    // From when on the others wait for a member: from the open round, or from the first round that it enters. The
    // latter may have been released without it; it then continues at once.
    enum class Awaited : uint8_t { AtOnce, FromItsFirstRound };
    void join(PeerId member, const std::string& name, Awaited awaited = Awaited::AtOnce);
    // A member is lost or leaves. The others no longer wait for it.
    void leave(PeerId member);
    Result<void> input(PeerId member, const EnterMessage& message, int64_t nowNs);
    // Sends the names of the missing members to those whose patience has ended. These leave the round.
    void tick(int64_t nowNs);

    [[nodiscard]] uint64_t round() const { return released_ + 1; } // open round of members that count

private:
    struct Member {
        std::string name;
        uint64_t since = 0;   // first round that waits for it
        uint64_t entered = 0; // the round that it waits for; 0: none
        int64_t deadlineNs = INT64_MAX;
        bool hasLeft = false; // its deadline has passed

        [[nodiscard]] bool isMissing(uint64_t round) const { return since <= round && entered < round; }
    };
    [[nodiscard]] uint64_t firstEntered() const;
    void releaseComplete();
    // Returns the names of the members that a round waits for, separated by commas.
    [[nodiscard]] std::string missing(uint64_t round) const;

    MessageSender sender_;
    const uint32_t barrier_;
    std::map<PeerId, Member> members_;
    uint64_t released_ = 0; // the latest round
};

// A member's side.
class ObjectBarrierMember {
public:
    // `name`: for messages.
    ObjectBarrierMember(MessageSink& sink, uint32_t barrier, std::string name)
        : sender_(sink), barrier_(barrier), name_(std::move(name)) {}

    // Enters a round; 0: the next one. `patienceMs`: time after which the leader names the missing members; 0: none.
    void enter(uint32_t patienceMs, uint64_t round = 0);
    void input(const GoMessage& message);
    void input(const LateMessage& message);

    // Returns the result of enter(): the number of members that entered, or an error that names the missing ones.
    // Empty: still waiting.
    [[nodiscard]] std::optional<Result<uint32_t>> result() const;

private:
    MessageSender sender_;
    const uint32_t barrier_;
    const std::string name_;
    uint64_t round_ = 0; // last released round
    bool isWaiting_ = false;
    std::optional<Result<uint32_t>> result_;
};

} // namespace mural::objects
