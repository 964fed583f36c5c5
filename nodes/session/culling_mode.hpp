// Whether nodes leave out vertices that cannot touch their area: the option --culling.
#pragma once

#include <cstdint>

namespace mural {

enum class CullingMode : uint8_t {
    Off,
    Auto,
    Audit // also counts the samples of everything that is left out
};

} // namespace mural
