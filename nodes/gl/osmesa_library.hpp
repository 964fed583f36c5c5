// The functions of libOSMesa and its GL. Mesa 25.1 removed libOSMesa, so it is loaded at run time where it exists.
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
