#include "interposer/loaded_gl.hpp"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <link.h>

#include "common/gl_library_names.hpp"

namespace mural {

namespace {

// The parts of a loaded object that names are looked up in.
struct Object {
    const ElfW(Dyn)* dynamic = nullptr;
    const char* strings = nullptr;
    const ElfW(Sym)* symbols = nullptr;
    const uint32_t* names = nullptr; // its DT_GNU_HASH

    explicit Object(const dl_phdr_info& info) {
        for (int i = 0; i < info.dlpi_phnum; ++i) {
            if (info.dlpi_phdr[i].p_type == PT_DYNAMIC) dynamic = reinterpret_cast<const ElfW(Dyn)*>(info.dlpi_addr + info.dlpi_phdr[i].p_vaddr);
        }
        for (const ElfW(Dyn)* d = dynamic; d && d->d_tag != DT_NULL; ++d) {
            if (d->d_un.d_ptr <= info.dlpi_addr) continue; // the loader has made it an address, except in the vDSO
            if (d->d_tag == DT_STRTAB) strings = reinterpret_cast<const char*>(d->d_un.d_ptr);
            if (d->d_tag == DT_SYMTAB) symbols = reinterpret_cast<const ElfW(Sym)*>(d->d_un.d_ptr);
            if (d->d_tag == DT_GNU_HASH) names = reinterpret_cast<const uint32_t*>(d->d_un.d_ptr);
        }
    }

    [[nodiscard]] bool leadsToGlvnd() const {
        for (const ElfW(Dyn)* d = dynamic; strings && d->d_tag != DT_NULL; ++d) {
            if (d->d_tag == DT_NEEDED && isGlvndDispatch(strings + d->d_un.d_val)) return true;
        }
        return false;
    }
    [[nodiscard]] bool hasGlName() const {
        for (const ElfW(Dyn)* d = dynamic; strings && d->d_tag != DT_NULL; ++d) {
            if (d->d_tag == DT_SONAME) return isGlLibraryName(strings + d->d_un.d_val);
        }
        return false;
    }
    // Whether it has a function of that name for others. Not by dlsym: that looks into what it needs as well.
    [[nodiscard]] bool exports(const char* name) const {
        if (!strings || !symbols || !names) return false;
        uint32_t hash = 5381;
        for (const char* c = name; *c; ++c) hash = hash * 33 + static_cast<unsigned char>(*c);
        const uint32_t bucketCount = names[0], firstSymbol = names[1], filterWords = names[2];
        const auto* buckets = names + 4 + filterWords * (sizeof(ElfW(Addr)) / sizeof(uint32_t));
        const uint32_t* chain = buckets + bucketCount;
        uint32_t i = bucketCount ? buckets[hash % bucketCount] : 0;
        if (i < firstSymbol || i == 0) return false;
        for (;; ++i) {
            const uint32_t other = chain[i - firstSymbol];
            const ElfW(Sym)& symbol = symbols[i];
            if ((other | 1) == (hash | 1) && !std::strcmp(strings + symbol.st_name, name))
                return symbol.st_shndx != SHN_UNDEF && ELF64_ST_TYPE(symbol.st_info) == STT_FUNC;
            if (other & 1) return false;
        }
    }
};

struct Path {
    char text[1024];
};

int findOwnGl(dl_phdr_info* info, size_t, void* into) {
    const Object object(*info);
    if (!info->dlpi_name || !info->dlpi_name[0] || !object.hasGlName() || object.leadsToGlvnd()) return 0;
    snprintf(static_cast<Path*>(into)->text, sizeof(Path::text), "%s", info->dlpi_name);
    return 1;
}

struct List {
    char* text;
    size_t sizeBytes, length;
    int count;
};

int addIfPastUs(dl_phdr_info* info, size_t, void* into) {
    const char* path = info->dlpi_name;
    if (!path || !path[0] || std::strstr(path, "/libGLX_mural.") || std::strstr(path, "/libmural_front.")) return 0;
    const Object object(*info);
    if (!object.exports("glClear") || object.leadsToGlvnd()) return 0;
    auto* list = static_cast<List*>(into);
    const char* separator = list->count ? " and " : "";
    const size_t more = std::strlen(separator) + std::strlen(path);
    if (list->length + more >= list->sizeBytes) return 1;
    snprintf(list->text + list->length, list->sizeBytes - list->length, "%s%s", separator, path);
    list->length += more;
    return ++list->count == 3;
}

} // namespace

const char* loadedOwnGl() {
    static Path found;
    return dl_iterate_phdr(findOwnGl, &found) ? found.text : nullptr;
}

bool librariesPastUs(char* into, size_t sizeBytes) {
    List list{into, sizeBytes, 0, 0};
    dl_iterate_phdr(addIfPastUs, &list);
    return list.count > 0;
}

} // namespace mural
