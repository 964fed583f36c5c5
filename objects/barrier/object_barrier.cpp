#include "objects/barrier/object_barrier.hpp"

namespace mural::objects {

namespace {

constexpr int64_t kNsPerPatienceMs = 1'000'000;

} // namespace

void ObjectBarrierLeader::join(PeerId member, const std::string& name) { members_[member].name = name; }

void ObjectBarrierLeader::leave(PeerId member) {
    members_.erase(member);
    releaseIfComplete();
}

Result<void> ObjectBarrierLeader::input(PeerId member, const EnterMessage& message, int64_t nowNs) {
    const auto found = members_.find(member);
    if (found == members_.end())
        return Error{"process " + std::to_string(member) + " is no member of barrier " + std::to_string(barrier_) +
                     "; it must join before it enters"};
    // A newcomer does not know the round. A member may not be ahead of it.
    if (message.round > round_)
        return Error{found->second.name + " enters round " + std::to_string(message.round) + " of barrier " +
                     std::to_string(barrier_) + " during round " + std::to_string(round_) + "; it is ignored"};
    found->second.hasEntered = true;
    found->second.deadlineNs =
        message.patienceMs == 0 ? INT64_MAX : nowNs + int64_t{message.patienceMs} * kNsPerPatienceMs;
    releaseIfComplete();
    return {};
}

void ObjectBarrierLeader::releaseIfComplete() {
    uint32_t entered = 0;
    for (const auto& [id, member] : members_) entered += member.hasEntered;
    if (entered == 0 || entered < members_.size()) return;
    const uint64_t round = round_++;
    for (auto& [id, member] : members_) {
        member.hasEntered = false;
        member.deadlineNs = INT64_MAX;
        sender_.toOne(id, GoMessage{barrier_, round, entered});
    }
}

std::string ObjectBarrierLeader::missing() const {
    std::string names;
    for (const auto& [id, member] : members_) {
        if (member.hasEntered) continue;
        if (!names.empty()) names += ", ";
        names += member.name;
    }
    return names;
}

void ObjectBarrierLeader::tick(int64_t nowNs) {
    const std::string names = missing();
    for (auto& [id, member] : members_) {
        if (!member.hasEntered || member.deadlineNs > nowNs) continue;
        sender_.toOne(id, LateMessage{barrier_, round_, names});
        member.hasEntered = false;
        member.deadlineNs = INT64_MAX;
    }
}

void ObjectBarrierMember::enter(uint32_t patienceMs) {
    isWaiting_ = true;
    result_.reset();
    sender_.toOne(kWriter, EnterMessage{barrier_, round_ == 0 ? 0 : round_ + 1, patienceMs});
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
    result_ = Result<uint32_t>(Error{"barrier " + std::to_string(barrier_) + " was not passed within the deadline: " +
                                     message.missing + " did not enter; enter again, or end these processes"});
}

std::optional<Result<uint32_t>> ObjectBarrierMember::result() const { return result_; }

} // namespace mural::objects
