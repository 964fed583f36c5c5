// Loads of an equalizer's children in one frame, from the measurements of the leaves below them.
#pragma once

#include "balancer/equalizers/frame_statistics.hpp"

namespace mural::balance {

struct ChildLoad {
    bool hasDrawn = false;
    double seconds = 0; // longest time of a channel below the child
    Viewport area;      // drawn part, relative to the area of the equalizer's compound
    Viewport interest;  // part of `area` with content
    Range range;        // drawn range, relative to the range of the equalizer's compound
};

class ChildLoads {
public:
    ChildLoads(const ResolvedConfig& config, Index compound);

    [[nodiscard]] const std::vector<Index>& children() const { return children_; }
    [[nodiscard]] size_t size() const { return children_.size(); }
    // Channel of a child, or kNone.
    [[nodiscard]] Index channel(size_t child) const { return channels_[child]; }
    [[nodiscard]] Index destination() const { return destination_; }

    // Reads a frame. Returns false if no child has drawn.
    bool read(const FrameStatistics& statistics);
    [[nodiscard]] const std::vector<ChildLoad>& loads() const { return loads_; }
    [[nodiscard]] double assemblySeconds() const { return assembly_; }

private:
    void addTime(size_t child, Index leaf, double seconds);
    void toOwnArea();

    struct ChannelTime {
        size_t child;
        Index channel;
        double seconds;
    };

    std::vector<Index> children_, channels_;
    Index destination_ = kNone;
    std::vector<int> childOf_;     // per compound: its child here, or -1
    std::vector<Index> executing_; // per compound
    std::vector<ChildLoad> loads_;
    std::vector<ChannelTime> times_;
    double assembly_ = 0;
};

} // namespace mural::balance
