// The strategy for so many ranks where nobody asks for one. Rules and measurements: docs/compositing.md, "Strategies measured".
#pragma once

#include "compositor/strategies/strategy.hpp"

namespace mural::compositor {

[[nodiscard]] Strategy chooseStrategy(int ranks);
// For a line to the user.
[[nodiscard]] const char* whyStrategy(int ranks);

} // namespace mural::compositor
