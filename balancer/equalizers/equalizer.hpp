// An equalizer adjusts the division of work from frame to frame. It receives the measurements of completed frames and
// changes the states of compounds before the next frame is planned. Pure: no clocks, sockets or threads.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "balancer/equalizers/frame_statistics.hpp"
#include "balancer/equalizers/parameters.hpp"

namespace mural::balance {

using compound::CompoundState;
using States = std::vector<CompoundState>; // one per compound of the configuration

// The next frame.
struct FrameContext {
    const ResolvedConfig& config;
    const compound::FrameInput& input; // its `compounds` are the states that update() changes
};

// The last decision of an equalizer, for state displays and traces.
struct Decision {
    uint64_t frame = 0;    // the planned frame
    uint64_t measured = 0; // newest frame of the measurements
    const char* what = "no measurements yet";
    bool moved = false;       // states changed
    double predictedGain = 0; // reduction of the longest time, as a fraction
    std::vector<std::pair<const char*, double>> inputs;
};

// The members of CompoundState that an equalizer sets.
enum class Effect : uint8_t { Viewports, Ranges, Usage, Zooms, FrameRates, Inputs };

class Equalizer {
public:
    // id: unique within a configuration. kind: the keyword of the format.
    Equalizer(std::string id, const char* kind, Index compound, Effect effect)
        : id_(std::move(id)), kind_(kind), compound_(compound), effect_(effect) {}
    virtual ~Equalizer() = default;
    Equalizer(const Equalizer&) = delete;
    Equalizer& operator=(const Equalizer&) = delete;

    [[nodiscard]] const std::string& id() const { return id_; }
    [[nodiscard]] const char* kind() const { return kind_; }
    [[nodiscard]] Index compound() const { return compound_; }
    [[nodiscard]] Effect effect() const { return effect_; }
    // The compounds whose states the equalizer sets, in the order of its decisions.
    [[nodiscard]] virtual std::vector<Index> targets(const ResolvedConfig& config) const {
        return config.compounds[at(compound_)].children;
    }
    [[nodiscard]] const Decision& lastDecision() const { return decision_; }
    [[nodiscard]] const Parameters& parameters() const { return parameters_; }
    Result<void> set(std::string_view parameter, std::string_view value) { return parameters_.set(parameter, value); }

    // A frozen equalizer observes, but leaves all states as they are. Equalizers that divide work still act when nodes
    // are lost or return.
    void freeze(bool frozen, const States& states);
    [[nodiscard]] bool isFrozen() const { return isFrozen_; }

    // Receives the frames in ascending order.
    virtual void observe(const FrameStatistics& statistics) = 0;
    // Changes the states for the next frame.
    void update(const FrameContext& context, States& states);

protected:
    virtual void decide(const FrameContext& context, States& states) = 0;

    Parameters parameters_;
    Decision decision_;

private:
    bool isAvailabilityChanged(const States& states);

    const std::string id_;
    const char* const kind_;
    const Index compound_;
    const Effect effect_;
    bool isFrozen_ = false;
    std::vector<bool> frozenAvailability_; // per compound, at the last update of a frozen equalizer
};

} // namespace mural::balance
