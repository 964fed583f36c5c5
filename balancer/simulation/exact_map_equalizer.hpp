// The best that a cost map can do: cuts the exact costs of the newest measured frame. Exists in simulations only.
#pragma once

#include "balancer/equalizers/cost_map/density_grid.hpp"
#include "balancer/equalizers/split/split_equalizer.hpp"
#include "balancer/simulation/cost_trace.hpp"

namespace mural::simulation {

class ExactMapEqualizer : public balance::SplitEqualizer {
public:
    // The trace must outlive the equalizer. Statistics of frame f belong to frame f modulo the trace's length.
    ExactMapEqualizer(std::string id, const config::ResolvedConfig& config, config::Index compound,
                      config::SplitMode mode, const CostTrace& trace, std::vector<double> speeds);

protected:
    bool split(const balance::FrameContext& context, const balance::CutRules& rules) override;
    void setUsage(const balance::States& states, std::vector<double>& usage) const override;

private:
    void cut(int node, const balance::Part& part, const balance::CutRules& rules);

    const CostTrace& trace_;
    const std::vector<double> speeds_; // per child
    balance::DensityGrid map_;
};

} // namespace mural::simulation
