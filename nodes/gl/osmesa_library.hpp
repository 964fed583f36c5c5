// The functions of libOSMesa and those of GL that come with it. libOSMesa has left Mesa with version
// 25.1: it is loaded where it is still there.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

#include "nodes/gl/dynamic_library.hpp"

namespace mural::gl {

struct OsmesaFunctions {
    decltype(&OSMesaCreateContextAttribs) createContextAttribs = nullptr;
    decltype(&OSMesaDestroyContext) destroyContext = nullptr;
    decltype(&OSMesaGetProcAddress) getProcAddress = nullptr;
    decltype(&OSMesaMakeCurrent) makeCurrent = nullptr;
};

} // namespace mural::gl
