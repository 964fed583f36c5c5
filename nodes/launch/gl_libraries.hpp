// Which GL libraries a program will have: those that GLVND leads to the vendor front, or others, which
// only the preloaded front sees.
#pragma once

#include <string>
#include <vector>

#include "nodes/launch/environment.hpp"

namespace mural::launch {

// How a library shows pictures, judged by its soname and by what it needs.
enum class Drawing {
    None,
    Glvnd,     // OpenGL, by way of GLVND
    OwnGl,     // OpenGL: a library that GLVND does not lead to
    OffScreen, // OSMesa: OpenGL into the program's own memory
    Vulkan,
    X11,       // what all windows need
};
Drawing drawingOf(const std::string& libraryPath);

// Paths of the program's GL libraries that GLVND does not lead to: of those that it links, or where it
// links none, of those that it would open by name. The dynamic loader itself is asked, so that rpaths,
// LD_LIBRARY_PATH and the loader's cache count as they will. Empty: none, or the loader does not tell.
std::vector<std::string> ownGlLibraries(const std::string& executable, const Environment& environment);

} // namespace mural::launch
