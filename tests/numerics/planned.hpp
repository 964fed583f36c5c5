// A configuration and the tasks of one frame.
#pragma once

#include <string>
#include <vector>

#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/resolve.hpp"

namespace mural::compound {

struct Planned {
    ResolvedConfig config;
    FramePlan plan;
};

// The draws of the channel of this name for an eye.
inline std::vector<RenderContext> drawn(const Planned& p, const std::string& channel, Eye eye) {
    std::vector<RenderContext> found;
    for (const ChannelPlan& one : p.plan.channels)
        for (const PlannedTask& t : one.tasks) {
            const RenderContext& c = p.plan.contexts[static_cast<size_t>(t.context)];
            if (t.kind == Task::Draw && c.eye == eye &&
                p.config.channels[static_cast<size_t>(one.channel)].name == channel)
                found.push_back(c);
        }
    return found;
}

} // namespace mural::compound
