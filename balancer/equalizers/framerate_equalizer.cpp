#include "balancer/equalizers/framerate_equalizer.hpp"

namespace mural::balance {

namespace {

constexpr size_t kMeanFrames = 10; // in the mean
constexpr double kMargin = 1.05;   // above the rate of the slowest, so that pacing never slows the session down
constexpr double kMostFps = 60;    // faster frames need no pace

} // namespace

FramerateEqualizer::FramerateEqualizer(std::string id, const ResolvedConfig& config, Index compound)
    : Equalizer(std::move(id), "framerate_equalizer", compound, Effect::FrameRates), children_(config, compound) {
    for (const Index child : children_.children())
        periods_.push_back(std::max(1u, config.compounds[at(child)].period.value_or(1)));
    seconds_.resize(periods_.size(), 0);
}

void FramerateEqualizer::observe(const FrameStatistics& statistics) {
    if (!children_.read(statistics)) return;
    decision_.measured = statistics.frameNumber;
    double interval = 0;
    for (size_t i = 0; i < periods_.size(); ++i) {
        if (children_.loads()[i].hasDrawn) seconds_[i] = children_.loads()[i].seconds;
        interval = std::max(interval, seconds_[i] / periods_[i]);
    }
    intervals_.push_back(interval);
    if (intervals_.size() > kMeanFrames) intervals_.pop_front();
}

void FramerateEqualizer::decide(const FrameContext&, States& states) {
    if (intervals_.empty()) return;
    double sum = 0;
    for (const double interval : intervals_) sum += interval;
    const double interval = sum / static_cast<double>(intervals_.size());
    const double paced = kMargin / interval;
    const double fps = paced > kMostFps ? 0 : paced;
    decision_.what = fps > 0 ? "frames begin at equal intervals" : "no pace: frames are fast enough";
    decision_.inputs = {{"interval", interval}, {"rate", fps}};
    decision_.moved = states[at(compound())].maxFps != fps;
    states[at(compound())].maxFps = fps;
    for (size_t i = 0; i < periods_.size(); ++i) states[at(children_.children()[i])].maxFps = fps / periods_[i];
}

} // namespace mural::balance
