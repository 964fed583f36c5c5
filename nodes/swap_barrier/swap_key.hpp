// Identifies a swap of a program's window on all nodes.
#pragma once

#include <cstdint>

namespace mural {

struct SwapKey {
    uint32_t client = 0;
    uint32_t window = 0;
    uint32_t frame = 0;
    friend bool operator==(const SwapKey&, const SwapKey&) = default;
};

} // namespace mural
