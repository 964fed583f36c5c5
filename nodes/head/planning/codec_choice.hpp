// Selects the codec of each node's pictures: the user's option, then the configuration file, then the fastest for the
// connection. Pure.
#pragma once

#include <string>

#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// asked: the value of --codec. Pictures in shared memory stay raw unless the user or the file names a codec.
void chooseCodecs(SessionPlan& plan, const std::string& requested);

} // namespace mural
