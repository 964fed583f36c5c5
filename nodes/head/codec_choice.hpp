// How pictures of nodes are packed on their way: as the user says, else as the file does, else by what is quickest there. Pure.
#pragma once

#include <string>

#include "nodes/head/node_plan.hpp"

namespace mural {

// asked: of --codec. Pictures that go to the head through memory are not packed unless somebody has said how.
void chooseCodecs(SessionPlan& plan, const std::string& asked);

} // namespace mural
