#include "interposer/preload/gl_objects.hpp"

#include "common/base/gl_library_names.hpp"
#include "interposer/loader/loaded_object.hpp"

namespace mural {

using loader::LoadedObject;

GlObject objectOf(const void* address) {
    GlObject kind = GlObject::Other;
    loader::findObject([&](const LoadedObject& object) {
        if (!object.contains(address)) return false;
        const char* name = object.soname();
        if (object.needs(isGlvndDispatch))
            kind = GlObject::Glvnd;
        else if (name && isGlLibraryName(name))
            kind = GlObject::Own;
        return true;
    });
    return kind;
}

bool isFromMural(const void* address) {
    bool isMural = false;
    loader::findObject([&](const LoadedObject& object) {
        if (!object.contains(reinterpret_cast<const void*>(&isFromMural))) return false;
        isMural = object.contains(address);
        return true;
    });
    return isMural;
}

} // namespace mural
