// Scenes in the order of their frames: frame n shows scene n % size, from another side in each round.
#pragma once

#include <array>

namespace mural::scenes {

inline constexpr std::array<const char*, 6> kSceneNames{"triangles", "lighting", "textures",
                                                        "lines",     "blending", "depths"};

} // namespace mural::scenes
