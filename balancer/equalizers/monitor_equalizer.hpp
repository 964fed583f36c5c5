// monitor_equalizer: shows the pictures of a wall's channels on one channel, each at its place in the view and scaled
// to the channel. Source: the Equalizer framework.
#pragma once

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

class MonitorEqualizer : public Equalizer {
public:
    MonitorEqualizer(std::string id, const ResolvedConfig& config, Index compound);

    void observe(const FrameStatistics&) override {} // sizes decide, not times

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    std::vector<Index> sources_; // per input frame: destination channel of its picture, or kNone
};

} // namespace mural::balance
