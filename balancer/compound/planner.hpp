// The steps of planFrame(): one traversal of the trees per eye, then the links between channels.
#pragma once

#include <map>
#include <string_view>
#include <unordered_map>

#include "balancer/compound/inheritance.hpp"
#include "balancer/compound/plan_frame.hpp"

namespace mural::compound {

// A compound that is active in one eye's pass.
struct ActiveCompound {
    Index compound = kNone;
    Inherited inherited;
    config::TaskSet tasks;
    Index context = kNone;
};

class Planner {
public:
    // Reuses the memory of `old`.
    Planner(const ResolvedConfig& config, const FrameInput& input, FramePlan old)
        : config_(config), input_(input), plan_(std::move(old)), channelPlans_(config.channels.size(), SIZE_MAX) {
        plan_.frameNumber = input.frameNumber;
        plan_.contexts.clear();
        plan_.frames.clear();
        plan_.queues.clear();
        plan_.channels.clear();
        plan_.barriers.clear();
        plan_.pipes.clear();
        plan_.interleaved = false;
        plan_.deadlock.clear();
        active_.reserve(config.compounds.size());
    }
    FramePlan run();

private:
    // One eye's pass over one tree: active compounds, then frames, then ordered tasks.
    void pass(Index root, Eye eye);
    void activate(Index compound, const Inherited* above, Eye eye);
    void joinBarrier(const ActiveCompound& active);
    Index contextOf(const ActiveCompound& active, Eye eye);
    void emit(Index compound);
    void add(const ActiveCompound& active, Task kind);

    // Defined in frame_links.cpp.
    void linkFrames(Eye eye);
    void offerFrames(const ActiveCompound& active, Eye eye);
    void takeFrames(const ActiveCompound& active);
    void placeFrame(const ActiveCompound& taker, const config::ResolvedFrame& wanted, const ActiveCompound& giver,
                    const PlannedFrame& frame, FrameUse& use) const;
    void dropUnused(size_t first);
    void addQueues();

    struct Offer {
        size_t active; // index into active_
        Index frame;   // index into plan_.frames
    };

    const ResolvedConfig& config_;
    const FrameInput& input_;
    FramePlan plan_;
    std::vector<size_t> channelPlans_; // per channel: index into plan_.channels
    // State of the current pass.
    std::vector<ActiveCompound> active_;
    std::vector<size_t> activeOf_;                       // per compound: index into active_, or SIZE_MAX
    std::unordered_map<std::string_view, Offer> offers_; // output frames by name
    std::map<std::string, Index> queues_;                // indices into plan_.queues by name
    std::vector<std::vector<Index>> outputs_;            // per entry of active_: indices into plan_.frames
    std::vector<std::vector<FrameUse>> inputs_;
};

// Orders the tasks of each pipe's channels so that no task waits for a later one. Sets `pipes` or `deadlock`.
void orderTasks(const ResolvedConfig& config, const DisplaySizes& sizes, FramePlan& plan);

} // namespace mural::compound
