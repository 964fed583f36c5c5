// Between the preloaded front and the library with the encoder: the one symbol that it takes from there.
#pragma once

extern "C" {
// The function that a program gets for `name` in place of that of a library that GLVND does not lead
// to; null: the library's own. `library` finds that library's functions, the same at every call. Null
// for all names when GLVND has been led through Mural in this process already.
void (*mural_front_entry(const char* name, void (*(*library)(const char* name))()))();
}
