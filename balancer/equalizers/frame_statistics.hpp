// Measurements of one completed frame, as the head supplies them to the equalizers. All times are in s on one clock.
#pragma once

#include "balancer/compound/render_context.hpp"

namespace mural::balance {

using compound::at;
using compound::Index;
using compound::kNone;
using compound::ResolvedConfig;

// Work of one leaf compound, summed over the eyes of the frame.
struct LeafStatistics {
    Index compound = kNone;
    double start = 0;                         // begin of its first task
    double end = 0;                           // end of its last task
    double busySeconds = 0;                   // clear, draw and readback
    double transferSeconds = 0;               // asynchronous readback and transmission, without waits
    Viewport viewport;                        // drawn part, relative to the destination
    Range range;                              // drawn range, relative to the scene
    Zoom zoom;                                // relative to the destination
    std::optional<Viewport> regionOfInterest; // relative to the destination; empty: the whole part

    // Returns the time that the leaf needs per frame. Drawing and transmission of consecutive frames overlap.
    [[nodiscard]] double loadSeconds() const { return std::max({busySeconds, transferSeconds, 1e-6}); }
};

// Returns the part that a context draws; the times are 0.
LeafStatistics leafOf(const compound::RenderContext& context, const compound::DisplaySizes& sizes);

struct RootStatistics {
    Index root = kNone;
    double frameSeconds = 0; // from the end of the previous frame to the end of this one
    bool isStill = false;    // the picture equals the previous one
};

struct AssemblyStatistics {
    Index channel = kNone; // destination
    double seconds = 0;
};

// Contains a leaf for each leaf compound that drew something. Frames with missing leaves are not supplied.
struct FrameStatistics {
    uint64_t frameNumber = 0;
    std::vector<LeafStatistics> leaves;
    std::vector<RootStatistics> roots;
    std::vector<AssemblyStatistics> assemblies;

    [[nodiscard]] double assemblySeconds(Index channel) const {
        double sum = 0;
        for (const AssemblyStatistics& a : assemblies)
            if (a.channel == channel) sum += a.seconds;
        return sum;
    }
};

} // namespace mural::balance
