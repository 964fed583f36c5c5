// Synthetic cost traces.
#pragma once

#include "balancer/simulation/cost_trace.hpp"

namespace mural::simulation {

struct Scene {
    const char* name;
    const char* what;
    bool isConstant; // the cost is the same in each frame
    int stepFrame;   // frame of the only change of the cost; 0: none
};

const std::vector<Scene>& scenes();
// Returns null for an unknown name.
const Scene* findScene(const std::string& name);
// Generates the costs of a scene: 1 s per frame where the scene does not say otherwise.
CostTrace makeScene(const Scene& scene, size_t frames, uint32_t seed);

} // namespace mural::simulation
