// view_equalizer (cross-segment load balancing): lends pipes of cheap parts of a wall to expensive ones. Each child
// shows one part; the usage of the leaves below it says how much of each pipe it gets. The load, tree and cost map
// equalizers of the children divide by that usage. Source: the Equalizer framework. Two faults of it are mended:
// transfer times count with their right sign, and small changes of the need change nothing.
#pragma once

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

class ViewEqualizer : public Equalizer {
public:
    ViewEqualizer(std::string id, const ResolvedConfig& config, Index compound);

    void observe(const FrameStatistics& statistics) override;

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    struct Leaf {
        Index compound;
        Index pipe;
    };
    struct Segment {
        Index ownPipe = kNone;
        std::vector<Leaf> leaves;
        double seconds = 0; // of all leaves, damped for their number
        double need = 0;    // in pipes
        double applied = 0; // need of the current usage
    };
    void collect(const ResolvedConfig& config, Index compound, Segment& segment);
    void assign(States& states);
    // Gives the segment what is left of the pipes that `permits` accepts.
    template <class Permits> void lend(Segment& segment, double& missing, Permits permits);

    std::vector<Segment> segments_;
    std::vector<double> free_;   // per pipe
    std::vector<int> served_;    // per pipe: segments
    std::vector<double> usage_;  // per compound
    std::vector<double> before_; // usage of the last assignment
    bool isMeasured_ = false;
    bool isAssigned_ = false;
};

} // namespace mural::balance
