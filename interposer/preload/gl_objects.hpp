// The GL libraries of this process: the owner of a function's code, and whether it uses GLVND.
#pragma once

namespace mural {

enum class GlObject {
    Other, // no GL library: the program's own functions, another tool's hooks
    Glvnd, // dispatches to vendor libraries, so the vendor entry captures it
    Own,   // a GL library without GLVND: old Mesa, a driver, ANGLE
};

// The kind of the object that contains the address.
GlObject objectOf(const void* address);
// True if the address is in the object that contains this function.
bool isFromMural(const void* address);

} // namespace mural
