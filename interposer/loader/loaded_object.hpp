// Reads the dynamic section of a loaded object: its name, its dependencies, its exported functions. It does not use
// dlsym, dlvsym or dlopen, as another preloaded library may have replaced them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <link.h>

namespace mural::loader {

class LoadedObject {
public:
    // Valid while the object is loaded.
    explicit LoadedObject(const dl_phdr_info& info);

    [[nodiscard]] const char* path() const { return path_; }
    [[nodiscard]] const char* soname() const; // null: none
    // Returns the function that the object defines under this name, in the default version. Null: none.
    [[nodiscard]] void* function(const char* name) const;
    [[nodiscard]] bool contains(const void* address) const;
    // Returns whether the predicate holds for the name of a library in its dependencies.
    template <class Predicate> [[nodiscard]] bool needs(Predicate predicate) const {
        for (const ElfW(Dyn)* d = dynamic_; strings_ && d && d->d_tag != DT_NULL; ++d)
            if (d->d_tag == DT_NEEDED && predicate(strings_ + d->d_un.d_val)) return true;
        return false;
    }

private:
    [[nodiscard]] bool isDefault(uint32_t symbol) const { return !versions_ || !(versions_[symbol] & 0x8000); }
    [[nodiscard]] bool defines(uint32_t symbol, const char* name) const;
    [[nodiscard]] uint32_t findByGnuHash(const char* name) const;
    [[nodiscard]] uint32_t findByHash(const char* name) const;

    ElfW(Addr) base_;
    const char* path_;
    const ElfW(Phdr) * segments_;
    size_t segmentCount_;
    const ElfW(Dyn) * dynamic_ = nullptr;
    const char* strings_ = nullptr;
    const ElfW(Sym) * symbols_ = nullptr;
    const ElfW(Half) * versions_ = nullptr;
    const uint32_t* gnuHash_ = nullptr;
    const uint32_t* hash_ = nullptr;
};

// Calls visit(object) for each loaded object in the loader's order until it returns true. Returns whether it did.
template <class Visit> bool findObject(Visit visit) {
    return dl_iterate_phdr([](dl_phdr_info* info, size_t,
                              void* data) { return (*static_cast<Visit*>(data))(LoadedObject(*info)) ? 1 : 0; },
                           &visit) != 0;
}

} // namespace mural::loader
