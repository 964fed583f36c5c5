// Base of the equalizers that divide the area or the range of a compound among its children: load, tree and cost map.
#pragma once

#include <optional>

#include "balancer/equalizers/split/child_loads.hpp"
#include "balancer/equalizers/split/split_tree.hpp"

namespace mural::balance {

class SplitEqualizer : public Equalizer {
public:
    void observe(const FrameStatistics& statistics) override;

    [[nodiscard]] const SplitTree& tree() const { return tree_; }

protected:
    // Adds the parameters damping, boundary, resistance and, with `assembleOnlyLimit`, assemble_only_limit.
    SplitEqualizer(std::string id, const char* kind, const ResolvedConfig& config, Index compound, SplitMode mode);
    void addCutParameters(double damping, const config::PixelsOrRange& boundary,
                          const config::PixelsOrRange& resistance);

    void decide(const FrameContext& context, States& states) final;
    // Processes one frame; called by observe().
    virtual void learn(const FrameStatistics&) {}
    // Moves the cuts of tree_. Called only after a measurement. Returns false to keep the parts.
    virtual bool split(const FrameContext& context, const CutRules& rules) = 0;
    // Number of resources of each child; by default the usage of its state, without lost leaves.
    virtual void setUsage(const States& states, std::vector<double>& usage) const;

    [[nodiscard]] SplitMode mode() const { return mode_; }

    ChildLoads children_;
    SplitTree tree_;
    PixelViewport area_; // of the compound, in the destination's window
    bool hasMeasurement_ = false;

private:
    [[nodiscard]] CutRules rules(const FrameContext& context, const States& states) const;
    bool divideUnmeasured(const CutRules& rules);

    SplitMode mode_;
    std::vector<std::vector<Index>> leaves_; // per child
    bool isNew_ = false;                     // measurements arrived after the last decision
    bool isReduced_ = false;                 // the parts of the first frame were replaced before any measurement
    std::vector<double> lastUsage_;
    uint32_t lastVersion_ = 0; // of the parameters
};

// Returns the area of a compound in its destination's window; empty without a destination.
PixelViewport areaOf(const FrameContext& context, Index compound);

} // namespace mural::balance
