// Creates the equalizers of a configuration.
#pragma once

#include <memory>

#include "balancer/equalizers/balance.hpp"
#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

// Returns the equalizers in order of decision: parents before children. Values outside the limits of a parameter become
// the nearest limit.
std::vector<std::unique_ptr<Equalizer>> makeEqualizers(const ResolvedConfig& config,
                                                       Balance balance = Balance::AsInFile);

} // namespace mural::balance
