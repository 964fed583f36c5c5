// Divides areas or ranges at random in every frame, for fault injection: pictures must not depend on the division.
#pragma once

#include <random>

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

class RandomEqualizer : public Equalizer {
public:
    // Takes the place of `other`, which sets viewports or ranges.
    RandomEqualizer(const Equalizer& other, const ResolvedConfig& config, uint32_t seed);

    void observe(const FrameStatistics&) override {}
    [[nodiscard]] std::vector<Index> targets(const ResolvedConfig&) const override { return targets_; }

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    const std::vector<Index> targets_;
    std::mt19937 random_;
};

} // namespace mural::balance
