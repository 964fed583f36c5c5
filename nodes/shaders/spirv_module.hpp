// What a tile has to know of a SPIR-V module. Source: SPIR-V 1.6, sections 2.3 and 3.
#pragma once

#include <cstddef>
#include <span>

namespace mural::shaders {

// A fragment shader in it may read gl_FragCoord. Also true for what is no module that we can read.
bool moduleReadsFragCoord(std::span<const std::byte> module);

} // namespace mural::shaders
