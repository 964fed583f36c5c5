// The operations stop-node and start-node: the end of one node in order, for maintenance, and its return. The control
// thread calls them.
//
// A member gives its area to others, and draws until all of its windows have taken that over. Then it leaves at one
// position of the stream: it sends everything about earlier packets, and Goodbye. Only then the session goes on without
// it, so no picture lacks a part.
#include <chrono>
#include <nlohmann/json.hpp>
#include <poll.h>

#include "common/log/log.hpp"
#include "nodes/head/session/head_session.hpp"

namespace mural {
namespace {

// The sum stays below the patience of mural ctl.
constexpr int64_t kHandOverMs = 4'000; // until a frame is drawn with the new areas
constexpr int64_t kLeaveMs = 4'000;    // until the node has finished its frames
constexpr int64_t kProcessMs = 1'000;

} // namespace

void HeadSession::addStopOperations(ControlOperations& operations) {
    operations.add(nodeOperation("stop-node", "end a node in order after its frames; start-node brings it back", true,
                                 [this](int node, bool isForced) { return stopNode(node, isForced); }));
    operations.add(nodeOperation("start-node",
                                 "start a node that was stopped, removed or given up; it joins with the current state",
                                 false, [this](int node, bool) { return startNode(node); }));
}

// Nodes that catch up draw nothing yet.
bool HeadSession::hasOtherMembers(int node) {
    for (int other = 0; other < nodeCount(); ++other)
        if (other != node && nodes_.link(other).alive() && !returns_->isRestarting(other)) return true;
    return false;
}

Result<void> HeadSession::stopNode(int node, bool isForced) {
    const std::string subject = nodes_.link(node).describe() + " cannot be stopped: ";
    if (!hasOtherMembers(node))
        return Error{subject + "it is the only node that draws at the moment; end the session with mural ctl stop"};
    const auto plan = plans_.nodePlan(node);
    if (plan->pass.ranges > 1 && !isForced)
        return Error{subject + "the nodes of its picture share the draws, and frames in progress would lack its range; "
                               "add force"};
    if (!plan->movesArea && !isForced)
        return Error{subject + "no other node takes its part of the picture; add force, or use --balance"};
    if (const auto leaves = returns_->leave(node); !leaves) return Error{subject + leaves.error().message};
    Result<void> done;
    if (plan->movesArea) done = handOver(node, Deadline::inMs(kHandOverMs));
    if (done || isForced) done = leaveAt(node, Deadline::inMs(kLeaveMs));
    if (done) return {};
    if (nodes_.link(node).alive()) { // otherwise its loss has the same effect as the stop
        returns_->stay(node);
        balancer()->takeBack(node);
    }
    return Error{subject + done.error().message};
}

Result<void> HeadSession::handOver(int node, Deadline deadline) {
    if (auto given = balancer()->giveUp(node); !given) return given;
    while (!balancer()->hasGivenUp(node)) {
        if (!nodes_.link(node).alive())
            return Error{"it was lost meanwhile; mural ctl start-node " + std::to_string(node) + " starts it again"};
        if (deadline.passed())
            return Error{"no frame was drawn without it within " + std::to_string(kHandOverMs / 1000) +
                         " s, since programs draw nothing or clear no window; try again while they draw, or add force"};
        poll(nullptr, 0, 2);
    }
    return {};
}

Result<void> HeadSession::leaveAt(int node, Deadline deadline) {
    NodeConnection& link = nodes_.link(node);
    {
        const std::lock_guard lock(mutex_);
        leaving_.insert(node);
        stopped_.erase(node); // of an earlier stop
    }
    const bool isDismissed = nodes_.dismiss(node, deadline);
    bool hasStopped = false;
    {
        std::unique_lock lock(mutex_);
        const auto slice = std::chrono::milliseconds(20);
        while (isDismissed && !stopped_.contains(node) && link.alive() && !deadline.passed())
            nodeStopped_.wait_for(lock, slice);
        hasStopped = stopped_.contains(node);
        if (!hasStopped) leaving_.erase(node);
    }
    if (!isDismissed) return Error{"a node accepts no data at the moment; see mural stat, and try again"};
    if (!hasStopped) {
        link.lose("it did not finish its last frames in time");
        return Error{"it did not finish its last frames in time, and was lost; mural ctl start-node " +
                     std::to_string(node) + " starts it again"};
    }
    const Deadline ended = Deadline::inMs(kProcessMs);
    while (!link.readerEnded() && !ended.passed()) poll(nullptr, 0, 1);
    link.endAfterGoodbye(ended);
    return {};
}

// Called by the node's reader thread, after all of its messages.
void HeadSession::memberLeft(int node) {
    const std::lock_guard membership(membership_);
    const std::string tiles = returns_->memberLost(node);
    goOnWithout(node);
    const std::lock_guard lock(mutex_);
    if (leavingSince_.contains(node))
        log::debug(log::Topic::Node, nodes_.link(node).describe(), " has left after its last frame");
    else
        log::info(log::Topic::Node, nodes_.link(node).describe(), " has stopped after its last frame; ", tiles,
                  "; mural ctl start-node ", node, " starts it again");
    feed_.publish(ControlTopic::Events, {{"event", "node-stopped"}, {"node", node}});
    leaving_.erase(node);
    stopped_.insert(node);
    nodeStopped_.notify_all();
}

Result<void> HeadSession::startNode(int node) {
    if (const auto comes = returns_->bringBack(node); !comes)
        return Error{nodes_.link(node).describe() + " cannot be started: " + comes.error().message};
    return {};
}

} // namespace mural
