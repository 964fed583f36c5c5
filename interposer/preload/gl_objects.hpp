// The GL libraries of this process: which object a function belongs to, and whether GLVND leads to it.
#pragma once

namespace mural {

enum class GlObject {
    Other, // no GL library: the program's own functions, another tool's hooks
    Glvnd, // hands everything to a vendor library, so the vendor front sees it
    Own,   // a GL library that does its work itself: old Mesa's, a driver's, ANGLE's
};

// What kind of object the code at the address belongs to.
GlObject objectOf(const void* address);
// The same code is part of the object that this function is in.
bool isOurs(const void* address);

} // namespace mural
