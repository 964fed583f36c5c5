#include "objects/barrier/object_barrier.hpp"

#include <algorithm>

namespace mural::objects {

namespace {

constexpr int64_t kNsPerPatienceMs = 1'000'000;

} // namespace

void ObjectBarrierLeader::join(PeerId member, const std::string& name, Awaited awaited) {
    Member joined;
    joined.name = name;
    joined.since = awaited == Awaited::AtOnce ? 0 : UINT64_MAX;
    members_[member] = joined;
}

void ObjectBarrierLeader::leave(PeerId member) {
    members_.erase(member);
    releaseComplete();
}

Result<void> ObjectBarrierLeader::input(PeerId id, const EnterMessage& message, int64_t nowNs) {
    const auto found = members_.find(id);
    if (found == members_.end())
        return Error{"process " + std::to_string(id) + " is no member of barrier " + std::to_string(barrier_) +
                     "; it must join before it enters"};
    Member& member = found->second;
    const uint64_t round = message.round == 0 ? released_ + 1 : message.round;
    member.since = std::min(member.since, round);
    if (round <= released_) { // of a newcomer, which was not awaited
        sender_.toOne(id, GoMessage{barrier_, round, static_cast<uint32_t>(members_.size())});
        return {};
    }
    member.entered = round;
    member.deadlineNs = message.patienceMs == 0 ? INT64_MAX : nowNs + int64_t{message.patienceMs} * kNsPerPatienceMs;
    releaseComplete();
    return {};
}

// The earliest round that a member waits for; 0: none.
uint64_t ObjectBarrierLeader::firstEntered() const {
    uint64_t first = 0;
    for (const auto& [id, member] : members_)
        if (member.entered != 0 && (first == 0 || member.entered < first)) first = member.entered;
    return first;
}

void ObjectBarrierLeader::releaseComplete() {
    while (const uint64_t round = firstEntered()) {
        uint32_t entered = 0;
        for (const auto& [id, member] : members_) {
            if (member.isMissing(round)) return;
            entered += member.entered >= round;
        }
        released_ = round;
        for (auto& [id, member] : members_) {
            if (member.entered != round) continue;
            member.entered = 0;
            member.deadlineNs = INT64_MAX;
            sender_.toOne(id, GoMessage{barrier_, round, entered});
        }
    }
}

std::string ObjectBarrierLeader::missing(uint64_t round) const {
    std::string names;
    for (const auto& [id, member] : members_) {
        if (!member.isMissing(round)) continue;
        if (!names.empty()) names += ", ";
        names += member.name;
    }
    return names;
}

void ObjectBarrierLeader::tick(int64_t nowNs) {
    for (auto& [id, member] : members_) {
        if (member.entered == 0 || member.deadlineNs > nowNs) continue;
        sender_.toOne(id, LateMessage{barrier_, member.entered, missing(member.entered)});
        member.deadlineNs = INT64_MAX;
        member.hasLeft = true;
    }
    for (auto& [id, member] : members_)
        if (std::exchange(member.hasLeft, false)) member.entered = 0;
}

void ObjectBarrierMember::enter(uint32_t patienceMs, uint64_t round) {
    isWaiting_ = true;
    result_.reset();
    const uint64_t next = round_ == 0 ? 0 : round_ + 1;
    sender_.toOne(kWriter, EnterMessage{barrier_, round == 0 ? next : round, patienceMs});
}

void ObjectBarrierMember::input(const GoMessage& message) {
    round_ = message.round;
    if (!isWaiting_) return; // gave up at the same moment; the round has ended for it as well
    isWaiting_ = false;
    result_ = Result<uint32_t>(message.entered);
}

void ObjectBarrierMember::input(const LateMessage& message) {
    if (!isWaiting_) return;
    isWaiting_ = false;
    result_ =
        Result<uint32_t>(Error{"barrier \"" + name_ + "\" was not passed within the deadline: " + message.missing +
                               " did not enter; enter again, or end these processes"});
}

std::optional<Result<uint32_t>> ObjectBarrierMember::result() const { return result_; }

} // namespace mural::objects
