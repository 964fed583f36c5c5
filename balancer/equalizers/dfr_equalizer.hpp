// DFR_equalizer (dynamic frame resolution): keeps a frame rate by the zoom of its compound. A program that stands still
// gets full resolution in the next frame. Source: the Equalizer framework.
#pragma once

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

class DfrEqualizer : public Equalizer {
public:
    DfrEqualizer(std::string id, const ResolvedConfig& config, Index compound, const config::DfrEqualizer& fields);

    void observe(const FrameStatistics& statistics) override;

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    [[nodiscard]] double leastZoom(const FrameContext& context) const;
    [[nodiscard]] double mostZoom(const FrameContext& context) const;

    Index root_ = kNone;
    Zoom full_;                // zoom of the file
    std::vector<bool> isHere_; // per compound: part of this compound's tree
    double zoom_ = 1;          // relative to the zoom of the file
    double wanted_ = 0;        // zoom for the target rate by the newest measurement; 0: no measurement
    double rate_ = 0;          // in Hz
    bool isStill_ = false;
};

} // namespace mural::balance
