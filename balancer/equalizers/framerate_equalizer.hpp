// framerate_equalizer: makes nodes that draw frames in turn begin them at equal intervals. Without it, frames of
// time-multiplex arrive in bursts. Source: the Equalizer framework.
#pragma once

#include <deque>

#include "balancer/equalizers/split/child_loads.hpp"
#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

class FramerateEqualizer : public Equalizer {
public:
    FramerateEqualizer(std::string id, const ResolvedConfig& config, Index compound);

    void observe(const FrameStatistics& statistics) override;

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    ChildLoads children_;
    std::vector<double> periods_;  // per child
    std::vector<double> seconds_;  // per child: its newest time
    std::deque<double> intervals_; // slowest child's time / period, of the last frames
};

} // namespace mural::balance
