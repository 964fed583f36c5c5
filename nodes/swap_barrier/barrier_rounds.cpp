#include "nodes/swap_barrier/barrier_rounds.hpp"

#include <algorithm>

namespace mural {

namespace {

constexpr size_t kMaxWindows = 256; // windows with a remembered last frame

} // namespace

bool BarrierRounds::passed(const SwapKey& key) const {
    const auto found = passed_.find({key.client, key.window});
    return found != passed_.end() && static_cast<int32_t>(key.frame - found->second) <= 0;
}

BarrierRounds::Step BarrierRounds::arrive(int member, const SwapKey& key, int64_t nowNs) {
    Step step;
    Member& m = members_[static_cast<size_t>(member)];
    if (m.state == State::Gone) return step;
    progressNs_ = nowNs;
    if (passed(key)) { // already released: the member lags
        m.state = State::Away;
        step.releases.push_back({key, {member}});
        return step;
    }
    m = {State::Waiting, key, ++arrivals_};
    releaseRounds(step, nowNs);
    return step;
}

BarrierRounds::Step BarrierRounds::gone(int member, int64_t nowNs) {
    Step step;
    members_[static_cast<size_t>(member)].state = State::Gone;
    releaseRounds(step, nowNs);
    return step;
}

BarrierRounds::Step BarrierRounds::tick(int64_t nowNs) {
    Step step;
    const bool waits = std::ranges::any_of(members_, [](const Member& m) { return m.state == State::Waiting; });
    if (!waits || nowNs - progressNs_ < patienceNs_) return step;
    for (size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].state != State::Away) continue;
        members_[i].state = State::Late;
        step.late.push_back(static_cast<int>(i));
    }
    releaseRounds(step, nowNs);
    return step;
}

void BarrierRounds::releaseRounds(Step& step, int64_t nowNs) {
    const Member* oldest = nullptr;
    for (const Member& m : members_) {
        if (m.state == State::Away) return;
        if (m.state == State::Waiting && (!oldest || m.order < oldest->order)) oldest = &m;
    }
    if (!oldest) return;
    Release release{oldest->key, {}};
    for (size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].state != State::Waiting || members_[i].key != release.key) continue;
        members_[i].state = State::Away;
        release.members.push_back(static_cast<int>(i));
    }
    if (passed_.size() >= kMaxWindows) passed_.erase(passed_.begin());
    passed_[{release.key.client, release.key.window}] = release.key.frame;
    progressNs_ = nowNs;
    step.releases.push_back(std::move(release));
}

} // namespace mural
