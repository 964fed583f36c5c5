// DFR_equalizer (dynamic frame resolution): keeps a frame rate by the zoom of its compound, up to the zoom of the file.
// A program that stands still gets that zoom, full resolution, in the next frame. Source: the Equalizer framework.
#pragma once

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

class DfrEqualizer : public Equalizer {
public:
    DfrEqualizer(std::string id, const ResolvedConfig& config, Index compound, const config::DfrEqualizer& fields);

    [[nodiscard]] std::vector<Index> targets(const ResolvedConfig&) const override { return {compound()}; }
    void observe(const FrameStatistics& statistics) override;

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    [[nodiscard]] double leastZoom(const FrameContext& context) const;

    Index root_ = kNone;
    Zoom full_; // zoom of the file
    // per compound of this tree: its side lengths at full resolution, relative to the destination; 0: another tree
    std::vector<double> fullSides_;
    double zoom_ = 1;   // relative to the zoom of the file, at most 1
    double wanted_ = 0; // zoom for the target rate by the newest measurement; 0: no measurement
    double rate_ = 0;   // in Hz
    bool isStill_ = false;
};

} // namespace mural::balance
