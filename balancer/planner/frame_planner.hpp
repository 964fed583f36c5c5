// The planner of a session. Each frame: statistics, equalizers, plan, difference to the previous plan. Pure.
#pragma once

#include <memory>

#include "balancer/compound/frame_plan.hpp"
#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

// A context that differs from the one of the same compound and eye in the previous plan.
struct ContextChange {
    enum class Kind : uint8_t { Appeared, Vanished, Changed } kind = Kind::Changed;
    Index compound = kNone;
    Eye eye = Eye::Cyclop;
    Index context = kNone; // index into the plan's contexts; kNone if it vanished
};

struct FrameChange {
    uint64_t frame = 0;
    std::vector<ContextChange> changes;
    [[nodiscard]] bool empty() const { return changes.empty(); }
};

class FramePlanner {
public:
    using Equalizers = std::vector<std::unique_ptr<Equalizer>>;

    FramePlanner(ResolvedConfig config, compound::FrameInput first, Equalizers equalizers);

    [[nodiscard]] const ResolvedConfig& config() const { return config_; }
    [[nodiscard]] const Equalizers& equalizers() const { return equalizers_; }
    [[nodiscard]] Equalizer* find(std::string_view id) const;
    // State of the next frame. Changes of layouts, views, observers and sizes apply to it.
    [[nodiscard]] compound::FrameInput& changeInput() {
        isInputChanged_ = true;
        return input_;
    }
    [[nodiscard]] const compound::FrameInput& input() const { return input_; }

    // Adds the measurements of a completed frame, in ascending order of frames.
    void addStatistics(const FrameStatistics& statistics);
    // Plans the next frame. The plan stays valid until the next call.
    const FrameChange& next();
    [[nodiscard]] const compound::FramePlan& plan() const { return plan_; }

private:
    void compare();
    [[nodiscard]] bool isSamePlan() const;

    const ResolvedConfig config_;
    compound::FrameInput input_;
    Equalizers equalizers_;
    compound::FramePlan plan_, previous_;
    FrameChange change_;
    States plannedStates_;       // states of the last plan
    bool isInputChanged_ = true; // since the last plan
    bool hasPeriods_ = false;    // plans depend on the frame number
};

} // namespace mural::balance
