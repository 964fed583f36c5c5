// The difference between the plan of a running session and another one. Pure.
//
// A node keeps its number for its whole life, and numbers are not used again. A node whose task is the same in both
// plans continues. Each other node of the new plan is a new one.
#pragma once

#include <functional>
#include <vector>

#include "nodes/head/planning/node_plan.hpp"

namespace mural {

struct PlanChange {
    SessionPlan plan; // the new plan with the numbers of the session; numbers without a node are vacant
    std::vector<int> kept, joining, leaving;
};

struct PlanInForce {
    const SessionConfig& config;
    const SessionPlan& plan;
    const SessionPlan& outputs; // of the start, whose canvases the session shows
};

// isMember: the node of the current plan draws at the moment. firstNumber: the first number that no node has had.
// Errors, one line each: the new plan needs outputs or transports that the session has not opened.
Result<PlanChange> changeOf(const PlanInForce& current, const SessionConfig& config, SessionPlan wanted,
                            const std::function<bool(int node)>& isMember, int firstNumber);

} // namespace mural
