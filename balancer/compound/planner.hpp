// The steps of planFrame(): one walk over the trees for each eye, then the pictures between channels.
#pragma once

#include <map>

#include "balancer/compound/inheritance.hpp"
#include "balancer/compound/plan_frame.hpp"

namespace mural::compound {

// An active compound in one eye's pass.
struct ActiveCompound {
    Index compound = kNone;
    Inherited inherited;
    config::TaskSet tasks;
    Index context = kNone;
};

class Planner {
public:
    Planner(const ResolvedConfig& config, const FrameInput& input)
        : config_(config), input_(input), channelPlans_(config.channels.size(), SIZE_MAX) {
        plan_.frameNumber = input.frameNumber;
    }
    FramePlan run();

private:
    // One eye's pass over one tree: what is active, then frames, then tasks in their order.
    void pass(Index root, Eye eye);
    void activate(Index compound, const Inherited* above, Eye eye);
    void joinBarrier(const ActiveCompound& active);
    Index contextOf(const ActiveCompound& active, Eye eye);
    void emit(Index compound);
    void add(const ActiveCompound& active, Task kind);

    // frame_links.cpp
    void linkFrames(Eye eye);
    void offerFrames(const ActiveCompound& active, Eye eye);
    void takeFrames(const ActiveCompound& active);
    void placeFrame(const ActiveCompound& taker, const config::ResolvedFrame& wanted, const ActiveCompound& giver, const PlannedFrame& frame,
                    FrameUse& use) const;
    void dropUnused(size_t first);
    void addQueues();

    struct Offer {
        size_t active; // in active_
        Index frame;   // in plan_.frames
    };

    const ResolvedConfig& config_;
    const FrameInput& input_;
    FramePlan plan_;
    std::vector<size_t> channelPlans_; // of each channel: in plan_.channels
    // Of the pass.
    std::vector<ActiveCompound> active_;
    std::vector<size_t> activeOf_;             // of each compound: in active_, or SIZE_MAX
    std::map<std::string, Offer> offers_;      // frames by their names
    std::map<std::string, Index> queues_;      // in plan_.queues
    std::vector<std::vector<Index>> outputs_;  // of each of active_: in plan_.frames
    std::vector<std::vector<FrameUse>> inputs_;
};

// In what order do the tasks of each pipe's channels run, so that none waits for a later one? Sets pipes or deadlock.
void orderTasks(const ResolvedConfig& config, const DisplaySizes& sizes, FramePlan& plan);

} // namespace mural::compound
