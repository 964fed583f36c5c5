#include "nodes/head/membership/node_group.hpp"

namespace mural {

void NodeGroup::ready(int node) {
    const std::lock_guard lock(mutex_);
    ready_.insert(node);
}

bool NodeGroup::areAllReady() const {
    const std::lock_guard lock(mutex_);
    return ready_.size() == nodes_.size();
}

Result<bool> NodeGroup::caughtUp(int node) {
    {
        const std::lock_guard lock(mutex_);
        if (outcome_ && !*outcome_) return outcome_->error();
        if (outcome_) return true;
        caughtUp_.insert(node);
        if (isAdmitting_ || caughtUp_.size() < nodes_.size()) return false;
        isAdmitting_ = true;
    }
    const Result<void> admitted = admit_(); // without the lock: it waits for the lock that orders packets
    const std::lock_guard lock(mutex_);
    outcome_ = admitted;
    if (!admitted) return admitted.error();
    return true;
}

void NodeGroup::fail(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (!outcome_ && !isAdmitting_) outcome_ = Result<void>(Error{why});
}

std::optional<Result<void>> NodeGroup::outcome() const {
    const std::lock_guard lock(mutex_);
    return outcome_;
}

bool NodeGroup::hasFailed() const {
    const std::lock_guard lock(mutex_);
    return outcome_ && !*outcome_;
}

} // namespace mural
