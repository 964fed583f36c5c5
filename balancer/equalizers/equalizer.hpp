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

class Equalizer {
public:
    // id: unique within a configuration. kind: the keyword of the format.
    Equalizer(std::string id, const char* kind, Index compound)
        : id_(std::move(id)), kind_(kind), compound_(compound) {}
    virtual ~Equalizer() = default;
    Equalizer(const Equalizer&) = delete;
    Equalizer& operator=(const Equalizer&) = delete;

    [[nodiscard]] const std::string& id() const { return id_; }
    [[nodiscard]] const char* kind() const { return kind_; }
    [[nodiscard]] Index compound() const { return compound_; }
    [[nodiscard]] const Decision& lastDecision() const { return decision_; }
    [[nodiscard]] const Parameters& parameters() const { return parameters_; }
    Result<void> set(std::string_view parameter, std::string_view value) { return parameters_.set(parameter, value); }

    // A frozen equalizer observes, but leaves all states as they are.
    void freeze(bool frozen) { isFrozen_ = frozen; }
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
    const std::string id_;
    const char* const kind_;
    const Index compound_;
    bool isFrozen_ = false;
};

} // namespace mural::balance
