// Properties of a SPIR-V module that matter to tiles. Source: SPIR-V 1.6, sections 2.3 and 3.
#pragma once

#include <cstddef>
#include <span>

namespace mural::shaders {

// Whether a fragment shader in it may read gl_FragCoord. True for an unreadable module.
bool moduleReadsFragCoord(std::span<const std::byte> module);

} // namespace mural::shaders
