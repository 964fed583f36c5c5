// The functions that compose the canvases of a plan from the pictures of its nodes.
#pragma once

#include <vector>

#include "nodes/head/frames/picture_assembler.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// Empty: the only picture is the canvas.
[[nodiscard]] PictureAssembler::Compose composeFirst(const SessionPlan& plan);

// outputs: the plan whose canvases the session shows. A canvas that is off in `plan` is black.
[[nodiscard]] std::vector<PictureAssembler::Compose> composeOthers(const SessionPlan& plan, const SessionPlan& outputs);

} // namespace mural
