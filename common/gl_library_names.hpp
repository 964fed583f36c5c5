// Names of GL libraries, as they stand in the dynamic section of ELF files. The preloaded front looks at
// loaded ones, `mural run` at files; both must come to the same result.
#pragma once

#include <cstring>
#include <string_view>

namespace mural {

// Those that programs link or open: libGL.so.1, libEGL.so.1, libGLESv1_CM.so.1, libGLESv2.so.2 and the
// split libraries of GLVND. Without a version it is another thing: browsers bring a libEGL.so
// (ANGLE) that itself goes through the system's.
constexpr std::string_view kGlLibraries[] = {"libGL.so.1", "libGLX.so.0", "libOpenGL.so.0", "libEGL.so.1", "libGLESv1_CM.so.1", "libGLESv2.so.2"};

inline bool isGlLibraryName(std::string_view soname) {
    for (const std::string_view name : kGlLibraries) {
        if (soname == name) return true;
    }
    return false;
}

// What all libraries of GLVND need, and no other.
inline bool isGlvndDispatch(std::string_view needed) { return needed == "libGLdispatch.so.0"; }

} // namespace mural
