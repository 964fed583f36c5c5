// Creates the equalizers of a configuration.
#pragma once

#include <memory>

#include "balancer/equalizers/equalizer.hpp"

namespace mural::balance {

// The equalizer that divides areas and ranges: --balance.
enum class Balance : uint8_t {
    AsInFile,
    Auto, // cost maps in place of load and tree equalizers
    Load,
    Tree,
    Off, // even split
};

// Returns the equalizers in the order in which they decide: those of a parent before those of its children. Values
// outside the limits of a parameter become the nearest limit.
std::vector<std::unique_ptr<Equalizer>> makeEqualizers(const ResolvedConfig& config,
                                                       Balance balance = Balance::AsInFile);

} // namespace mural::balance
