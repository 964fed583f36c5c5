// Determines the GL libraries that a program will load: those that use GLVND, and others, which need the preload
// library.
#pragma once

#include <string>
#include <vector>

#include "nodes/launch/environment.hpp"

namespace mural::launch {

// The kind of a library, judged by its soname and its dependencies.
enum class Drawing {
    None,
    Glvnd,     // OpenGL through GLVND
    OwnGl,     // OpenGL without GLVND
    OffScreen, // OSMesa: OpenGL into the program's memory
    Vulkan,
    X11, // window system only
};
Drawing drawingOf(const std::string& libraryPath);

// Paths of the program's GL libraries that do not use GLVND: the linked ones, or if it links none, those that it would
// open by name. Runs the dynamic loader, so that rpaths, LD_LIBRARY_PATH and the loader's cache apply. Empty: none, or
// the loader gives no answer.
std::vector<std::string> ownGlLibraries(const std::string& executable, const Environment& environment);

} // namespace mural::launch
