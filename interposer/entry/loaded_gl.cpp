#include "interposer/entry/loaded_gl.hpp"

#include <cstdio>
#include <cstring>

#include "common/base/gl_library_names.hpp"
#include "interposer/loader/loaded_object.hpp"

namespace mural {

namespace {

using loader::LoadedObject;

bool leadsToGlvnd(const LoadedObject& object) { return object.needs(isGlvndDispatch); }

bool isOwnGl(const LoadedObject& object) {
    const char* name = object.soname();
    return object.path()[0] && name && isGlLibraryName(name) && !leadsToGlvnd(object);
}

// Returns whether the object exports GL names that bypass GLVND and Mural. Does not use dlsym, which also searches the
// object's dependencies.
bool isPastUs(const LoadedObject& object) {
    const char* path = object.path();
    return path[0] && !std::strstr(path, "/libGLX_mural.") && !std::strstr(path, "/libmural_preload.") &&
           object.function("glClear") && !leadsToGlvnd(object);
}

} // namespace

const char* loadedOwnGl() {
    static char found[1024];
    const bool any = loader::findObject([](const LoadedObject& object) {
        if (!isOwnGl(object)) return false;
        snprintf(found, sizeof found, "%s", object.path());
        return true;
    });
    return any ? found : nullptr;
}

bool librariesPastUs(char* into, size_t sizeBytes) {
    size_t length = 0;
    int count = 0;
    loader::findObject([&](const LoadedObject& object) {
        if (!isPastUs(object)) return false;
        const char* separator = count ? " and " : "";
        const size_t more = std::strlen(separator) + std::strlen(object.path());
        if (length + more >= sizeBytes) return true;
        snprintf(into + length, sizeBytes - length, "%s%s", separator, object.path());
        length += more;
        return ++count == 3;
    });
    return count > 0;
}

} // namespace mural
