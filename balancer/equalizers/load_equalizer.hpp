// load_equalizer: moves each cut to the place at which the measured times on both sides are in proportion to their
// resources. The times of the last frame's parts count as spread evenly over their areas. Source: the Equalizer
// framework. Two faults of it are mended: damping is towards the previous split, not towards the even one; and
// transfer times count.
#pragma once

#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

class LoadEqualizer : public SplitEqualizer {
public:
    LoadEqualizer(std::string id, const ResolvedConfig& config, Index compound, const config::LoadEqualizer& fields);

protected:
    bool split(const FrameContext& context, const CutRules& rules) override;
    void setUsage(const States& states, std::vector<double>& usage) const override;

private:
    struct Tile {
        Part part;
        double seconds;
    };
    void divide(int node, const Part& part, const std::vector<Tile>& tiles, const CutRules& rules, double damping);
};

} // namespace mural::balance
