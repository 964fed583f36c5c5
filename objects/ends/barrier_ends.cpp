#include "objects/ends/barrier_ends.hpp"

#include <algorithm>
#include <condition_variable>

#include "objects/core/object_names.hpp"
#include "objects/ends/queue_ends.hpp"

namespace mural {

namespace objects {

namespace {

constexpr size_t kMaxBarriers = 4096;
constexpr int64_t kBarrierWaitSliceNs = 50'000'000; // bounds the error of deadlines that pause with the process
constexpr int64_t kLeaderGraceNs = 1'000'000'000;   // after the deadline, for the leader's reply

} // namespace

void BarrierHub::join(PeerId member, const std::string& name, Awaited awaited) {
    const std::lock_guard lock(mutex_);
    members_[member] = name;
    for (auto& [number, leader] : leaders_) leader.join(member, name, awaited);
}

void BarrierHub::join(std::string_view barrier, PeerId member, const std::string& name) {
    const std::lock_guard lock(mutex_);
    if (ObjectBarrierLeader* const leader = leaderOf(numberOfName(barrier))) leader->join(member, name);
}

ObjectBarrierLeader* BarrierHub::leaderOf(uint32_t barrier) {
    const auto found = leaders_.find(barrier);
    if (found != leaders_.end()) return &found->second;
    if (leaders_.size() >= kMaxBarriers) return nullptr;
    ObjectBarrierLeader& leader = leaders_.try_emplace(barrier, sink_, barrier).first->second;
    for (const auto& [id, name] : members_) leader.join(id, name);
    return &leader;
}

void BarrierHub::leave(PeerId member) {
    const std::lock_guard lock(mutex_);
    members_.erase(member);
    for (auto& [number, leader] : leaders_) leader.leave(member);
}

Result<void> BarrierHub::input(PeerId member, std::span<const std::byte> bytes, int64_t nowNs) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    const auto* const enter = std::get_if<EnterMessage>(&*message);
    if (!enter) return unexpectedMessage(*message, "the leader of barriers");
    const std::lock_guard lock(mutex_);
    ObjectBarrierLeader* const leader = leaderOf(enter->barrier);
    if (leader) return leader->input(member, *enter, nowNs);
    return Error{"process " + std::to_string(member) + " enters a new barrier beside " + std::to_string(kMaxBarriers) +
                 " others; use fewer barriers"};
}

void BarrierHub::tick(int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    for (auto& [number, leader] : leaders_) leader.tick(nowNs);
}

struct BarrierLine::Core {
    explicit Core(MessageSink& theSink) : sink(theSink) {}

    std::mutex mutex;
    std::condition_variable arrival;
    MessageSink& sink;
    std::map<uint32_t, ObjectBarrierMember> members;
    std::function<bool(Deadline)> receive; // see BarrierLine::waitBy
    std::function<uint64_t()> frame;       // see BarrierLine::countByFrames
    struct Position {
        uint64_t frame = 0;
        uint64_t times = 0;
    };
    std::map<uint32_t, Position> positions; // by barrier

    // Returns the next round of a barrier in the current frame; 0: members count rounds.
    uint64_t nextRound(uint32_t barrier) {
        constexpr uint64_t kRoundsPerFrame = 1 << 16;
        if (!frame) return 0;
        Position& at = positions[barrier];
        const uint64_t now = frame();
        at.times = now == at.frame ? at.times + 1 : 1;
        at.frame = now;
        return (now + 1) * kRoundsPerFrame + at.times;
    }
    // A member that was late enters the same round again.
    void repeatRound(uint32_t barrier) {
        if (const auto at = positions.find(barrier); at != positions.end() && at->second.times > 0) --at->second.times;
    }
    bool isClosed = false;
};

} // namespace objects

class Barrier::Member {
public:
    Member(std::shared_ptr<objects::BarrierLine::Core> core, std::string_view name)
        : core_(std::move(core)), name_(name), number_(objects::numberOfName(name)) {}

    Result<uint32_t> enter(Deadline deadline) {
        std::unique_lock lock(core_->mutex);
        if (core_->isClosed) return over();
        objects::ObjectBarrierMember& member = core_->members.at(number_);
        const int64_t leftNs = deadline.leftNs();
        const int64_t leftMs = (leftNs + kNsPerMs - 1) / kNsPerMs;
        const auto patienceMs =
            leftNs == INT64_MAX ? 0U : static_cast<uint32_t>(std::clamp<int64_t>(leftMs, 1, UINT32_MAX));
        member.enter(patienceMs, core_->nextRound(number_));
        int64_t lateSinceNs = 0;
        for (;;) {
            if (const auto result = member.result()) {
                if (!*result) core_->repeatRound(number_);
                return *result;
            }
            if (core_->isClosed) return over();
            if (deadline.passed()) {
                if (lateSinceNs == 0) lateSinceNs = monotonicNowNs();
                if (monotonicNowNs() - lateSinceNs > objects::kLeaderGraceNs) {
                    core_->repeatRound(number_);
                    return Error{"barrier \"" + name_ +
                                 "\" was not passed within the deadline, and the session does "
                                 "not reply; see its log"};
                }
            }
            const int64_t sliceNs = std::max<int64_t>(deadline.leftNs(objects::kBarrierWaitSliceNs), kNsPerMs);
            if (core_->receive) {
                lock.unlock();
                const bool mayArrive = core_->receive(Deadline::inMs(sliceNs / kNsPerMs));
                lock.lock();
                if (!mayArrive) return over();
                continue;
            }
            core_->arrival.wait_for(lock, std::chrono::nanoseconds(sliceNs));
        }
    }

private:
    [[nodiscard]] Error over() const { return {"barrier \"" + name_ + "\": the session is over"}; }

    const std::shared_ptr<objects::BarrierLine::Core> core_;
    const std::string name_;
    const uint32_t number_;
};

Result<uint32_t> Barrier::enter(Deadline deadline) { return member_->enter(deadline); }

namespace objects {

BarrierLine::BarrierLine(MessageSink& sink) : core_(std::make_shared<Core>(sink)) {}

Barrier BarrierLine::open(std::string_view name) {
    const std::lock_guard lock(core_->mutex);
    core_->members.try_emplace(numberOfName(name), core_->sink, numberOfName(name), std::string(name));
    return Barrier(std::make_shared<Barrier::Member>(core_, name));
}

Result<void> BarrierLine::input(std::span<const std::byte> bytes) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    const auto* const go = std::get_if<GoMessage>(&*message);
    const auto* const late = std::get_if<LateMessage>(&*message);
    if (!go && !late) return unexpectedMessage(*message, "a member of barriers");
    {
        const std::lock_guard lock(core_->mutex);
        const auto found = core_->members.find(go ? go->barrier : late->barrier);
        if (found == core_->members.end()) return {};
        if (go) found->second.input(*go);
        if (late) found->second.input(*late);
    }
    core_->arrival.notify_all();
    return {};
}

void BarrierLine::waitBy(std::function<bool(Deadline)> receive) { core_->receive = std::move(receive); }

void BarrierLine::countByFrames(std::function<uint64_t()> frame) { core_->frame = std::move(frame); }

void BarrierLine::close() {
    {
        const std::lock_guard lock(core_->mutex);
        core_->isClosed = true;
    }
    core_->arrival.notify_all();
}

} // namespace objects
} // namespace mural
