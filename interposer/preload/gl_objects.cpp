#include "interposer/preload/gl_objects.hpp"

#include <cstring>
#include <dlfcn.h>
#include <link.h>

#include "common/gl_library_names.hpp"

namespace mural {

namespace {

// Addresses in the dynamic section have the object's place added already, except in the vDSO, which
// holds no GL.
const char* stringsOf(const link_map* object) {
    for (const ElfW(Dyn)* d = object->l_ld; d->d_tag != DT_NULL; ++d) {
        if (d->d_tag == DT_STRTAB) return reinterpret_cast<const char*>(d->d_un.d_ptr);
    }
    return nullptr;
}

const link_map* objectAt(const void* address) {
    Dl_info info{};
    void* object = nullptr;
    if (!address || !dladdr1(address, &info, &object, RTLD_DL_LINKMAP)) return nullptr;
    return static_cast<const link_map*>(object);
}

} // namespace

GlObject objectOf(const void* address) {
    const link_map* object = objectAt(address);
    const char* strings = object && object->l_ld ? stringsOf(object) : nullptr;
    if (!strings) return GlObject::Other;
    bool isGl = false;
    for (const ElfW(Dyn)* d = object->l_ld; d->d_tag != DT_NULL; ++d) {
        if (d->d_tag == DT_NEEDED && isGlvndDispatch(strings + d->d_un.d_val)) return GlObject::Glvnd;
        if (d->d_tag == DT_SONAME) isGl = isGlLibraryName(strings + d->d_un.d_val);
    }
    return isGl ? GlObject::Own : GlObject::Other;
}

bool isOurs(const void* address) {
    static const link_map* ours = objectAt(reinterpret_cast<const void*>(&isOurs));
    return objectAt(address) == ours;
}

} // namespace mural
