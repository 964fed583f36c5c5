// Names of GL libraries in the dynamic section of ELF files. The capture library applies them to loaded libraries, and
// `mural run` to files, with the same result.
#pragma once

#include <cstring>
#include <string_view>

namespace mural {

// Libraries that programs link or open, including the split libraries of GLVND. Names without a version do not count:
// browsers ship a libEGL.so (ANGLE) that itself uses the system's.
constexpr std::string_view kGlLibraries[] = {"libGL.so.1",  "libGLX.so.0",       "libOpenGL.so.0",
                                             "libEGL.so.1", "libGLESv1_CM.so.1", "libGLESv2.so.2"};

inline bool isGlLibraryName(std::string_view soname) {
    for (const std::string_view name : kGlLibraries) {
        if (soname == name) return true;
    }
    return false;
}

// Every library of GLVND needs libGLdispatch, and no other library does.
inline bool isGlvndDispatch(std::string_view needed) { return needed == "libGLdispatch.so.0"; }

} // namespace mural
