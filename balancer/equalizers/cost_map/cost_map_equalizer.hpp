// Divides a picture or a range by a persistent map of its cost. The default of --balance auto.
//
// The map holds a density per cell. Each frame multiplies the density within each child's part by measured / predicted
// time, so the map keeps what earlier cuts have revealed. Cuts of a k-d tree halve the map by the resources of the
// children. Cuts move only for a promised gain above the noise of the measurements, and rest when the gain does not
// arrive; a change of the load ends the rest. Design and measurements: docs/measurements/balancing.md.
#pragma once

#include "balancer/equalizers/cost_map/change_watch.hpp"
#include "balancer/equalizers/cost_map/density_grid.hpp"
#include "balancer/equalizers/cost_map/helper_count.hpp"
#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

class CostMapEqualizer : public SplitEqualizer {
public:
    CostMapEqualizer(std::string id, const ResolvedConfig& config, Index compound, SplitMode mode);

    [[nodiscard]] const DensityGrid& map() const { return map_; }
    [[nodiscard]] double speedOf(size_t child) const { return speeds_[child]; } // relative to the mean
    [[nodiscard]] bool isResting() const { return isResting_; }

protected:
    void learn(const FrameStatistics& statistics) override;
    bool split(const FrameContext& context, const CutRules& rules) override;
    void setUsage(const States& states, std::vector<double>& usage) const override;

private:
    void makeMap();
    void watch();
    void correctMap();
    double findResiduals();
    bool smoothMap(bool isFirst);
    [[nodiscard]] Viewport cellsOf(const Part& part) const;
    void learnSpeeds();
    void remember();
    void recall();
    [[nodiscard]] double sureDeviations() const;
    void cut(SplitTree& tree, int node, const Part& part, const CutRules& rules) const;
    // Returns the longest predicted time of the parts.
    [[nodiscard]] double longestOf(const std::vector<Part>& parts) const;
    // Returns the gain that noise alone promises.
    [[nodiscard]] double noiseGain() const;
    // Returns the expected largest deviation of the children's times, in standard deviations.
    [[nodiscard]] double noiseDeviations() const;
    bool isOtherUsage(const std::vector<double>& usage);
    void endRest();
    void rest(const char* why);

    DensityGrid map_;               // in seconds of a child with speed 1
    std::vector<double> speeds_;    // per child
    std::vector<double> residuals_; // per child: logarithm of measured / predicted time in the last frame
    std::vector<double> surprises_, costs_;
    struct Memory {
        std::vector<Part> parts;
        std::vector<double> costs; // fractions of the total
    };
    std::vector<Memory> memory_;
    std::vector<double> usage_; // resources of the current cuts
    ChangeWatch watch_;
    HelperCount helpers_;
    std::vector<Part> drawn_;     // parts of the last measured frame
    std::vector<double> seconds_; // and their times

    // Following: cuts move. Resting: cuts stay until the load changes.
    bool isResting_ = false;
    bool isChanged_ = false; // the load has changed during the rest
    bool isVarying_ = false; // the last rest was short
    int followedFrames_ = 0; // since the begin of following
    int patience_ = 0;       // frames of following before a rest that shows whether the load itself changes
    int restedFrames_ = 0;
};

} // namespace mural::balance
