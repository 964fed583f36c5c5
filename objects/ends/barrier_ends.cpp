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

void BarrierHub::join(PeerId member, const std::string& name) {
    const std::lock_guard lock(mutex_);
    members_[member] = name;
    for (auto& [number, leader] : leaders_) leader.join(member, name);
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
    auto found = leaders_.find(enter->barrier);
    if (found == leaders_.end()) {
        if (leaders_.size() >= kMaxBarriers)
            return Error{"process " + std::to_string(member) + " enters a new barrier beside " +
                         std::to_string(kMaxBarriers) + " others; use fewer barriers"};
        found = leaders_.try_emplace(enter->barrier, sink_, enter->barrier).first;
        for (const auto& [id, name] : members_) found->second.join(id, name);
    }
    return found->second.input(member, *enter, nowNs);
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
        member.enter(leftNs == INT64_MAX ? 0 : static_cast<uint32_t>(std::clamp<int64_t>(leftMs, 1, UINT32_MAX)));
        int64_t lateSinceNs = 0;
        for (;;) {
            if (const auto result = member.result()) return *result;
            if (core_->isClosed) return over();
            if (deadline.passed()) {
                if (lateSinceNs == 0) lateSinceNs = monotonicNowNs();
                if (monotonicNowNs() - lateSinceNs > objects::kLeaderGraceNs)
                    return Error{"barrier \"" + name_ +
                                 "\" was not passed within the deadline, and the session does "
                                 "not reply; see its log"};
            }
            const int64_t sliceNs = std::max<int64_t>(deadline.leftNs(objects::kBarrierWaitSliceNs), kNsPerMs);
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
    core_->members.try_emplace(numberOfName(name), core_->sink, numberOfName(name));
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

void BarrierLine::close() {
    {
        const std::lock_guard lock(core_->mutex);
        core_->isClosed = true;
    }
    core_->arrival.notify_all();
}

} // namespace objects
} // namespace mural
