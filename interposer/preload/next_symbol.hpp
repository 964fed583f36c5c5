// dlsym, in front of libc's: programs that open a GL library and look its functions up by name (SDL,
// GLFW, Qt do) go round exported names. Names of GL are answered with what the front has for them.
#pragma once

namespace mural {

// What a program gets for a name of GL that it looked up and that is `found`; implemented by the front.
void* replaceFound(const char* name, void* found);

} // namespace mural
