// tree_equalizer: compares the times of both halves of each cut and moves the cut in proportion. It needs no areas of
// the last frame. Source: the Equalizer framework. Two faults of it are mended: in mode 2D the cuts alternate, and
// the resistance of horizontal cuts uses the height.
#pragma once

#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

class TreeEqualizer : public SplitEqualizer {
public:
    TreeEqualizer(std::string id, const ResolvedConfig& config, Index compound, const config::TreeEqualizer& fields);

protected:
    bool split(const FrameContext& context, const CutRules& rules) override;

private:
    [[nodiscard]] double timeOf(const SplitNode& node) const;
    void divide(int node, const Part& part, const CutRules& rules, double damping);
};

} // namespace mural::balance
