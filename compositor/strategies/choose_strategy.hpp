// Default strategy for a number of ranks. Rules and measurements: docs/measurements/compositing.md, "Strategies".
#pragma once

#include "compositor/strategies/strategy.hpp"

namespace mural::compositor {

[[nodiscard]] Strategy chooseStrategy(int ranks);
// Returns the reason, for a message to the user.
[[nodiscard]] const char* whyStrategy(int ranks);

} // namespace mural::compositor
