// The interface between the preloaded entry and the capture library: a single symbol.
#pragma once

extern "C" {
// The function that replaces `name` of a library without GLVND; null: use the library's own. `library` finds that
// library's functions and is the same at every call. Null for all names if GLVND has already loaded Mural in this
// process.
void (*mural_preload_entry(const char* name, void (*(*library)(const char* name))()))();
}
