// The choice of equalizers that divide areas and ranges (--balance).
#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace mural::balance {

enum class Balance : uint8_t {
    AsInFile, // the equalizers of the configuration
    Auto,     // cost maps in place of load and tree equalizers
    Load,     // load equalizers in place of both
    Tree,     // tree equalizers in place of both
    Off,      // none: the even split
};

// Values of --balance.
inline constexpr std::array<std::pair<Balance, const char*>, 5> kBalanceNames = {{{Balance::AsInFile, "file"},
                                                                                  {Balance::Auto, "auto"},
                                                                                  {Balance::Load, "load"},
                                                                                  {Balance::Tree, "tree"},
                                                                                  {Balance::Off, "off"}}};

} // namespace mural::balance
