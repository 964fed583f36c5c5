// Summaries of simulated courses.
#pragma once

#include "balancer/simulation/simulator.hpp"

namespace mural::simulation {

struct Measures {
    double mean = 0;          // efficiency
    double fifth = 0;         // 5th percentile of the efficiency
    double travel = 0;        // mean per frame
    int lastMove = 0;         // last frame whose parts differ from those of the frame before
    int settled = 0;          // first frame from which the efficiency stays within 5 % of its final mean
    double worseThanEven = 0; // fraction of frames with a longer longest time than the even split's, by 1 % or more
};

// even: the outcome of the even split under the same conditions.
Measures measuresOf(const Outcome& outcome, const Outcome& even);

// Returns the frames between the measurement of a step of the load and the frame whose efficiency reaches 90 % of the
// mean of the last ten frames. `step`: first frame of the new load.
int framesToFollow(const Outcome& outcome, int step, int latency);

} // namespace mural::simulation
