#include "interposer/loader/loaded_object.hpp"

#include <cstring>

namespace mural::loader {

LoadedObject::LoadedObject(const dl_phdr_info& info)
    : base_(info.dlpi_addr),
      path_(info.dlpi_name ? info.dlpi_name : ""),
      segments_(info.dlpi_phdr),
      segmentCount_(info.dlpi_phnum) {
    for (size_t i = 0; i < segmentCount_; ++i)
        if (segments_[i].p_type == PT_DYNAMIC)
            dynamic_ = reinterpret_cast<const ElfW(Dyn)*>(base_ + segments_[i].p_vaddr);
    for (const ElfW(Dyn)* d = dynamic_; d && d->d_tag != DT_NULL; ++d) {
        if (d->d_un.d_ptr <= base_) continue; // the loader has relocated it to an address, except in the vDSO
        if (d->d_tag == DT_STRTAB) strings_ = reinterpret_cast<const char*>(d->d_un.d_ptr);
        if (d->d_tag == DT_SYMTAB) symbols_ = reinterpret_cast<const ElfW(Sym)*>(d->d_un.d_ptr);
        if (d->d_tag == DT_VERSYM) versions_ = reinterpret_cast<const ElfW(Half)*>(d->d_un.d_ptr);
        if (d->d_tag == DT_GNU_HASH) gnuHash_ = reinterpret_cast<const uint32_t*>(d->d_un.d_ptr);
        if (d->d_tag == DT_HASH) hash_ = reinterpret_cast<const uint32_t*>(d->d_un.d_ptr);
    }
}

const char* LoadedObject::soname() const {
    for (const ElfW(Dyn)* d = dynamic_; strings_ && d && d->d_tag != DT_NULL; ++d)
        if (d->d_tag == DT_SONAME) return strings_ + d->d_un.d_val;
    return nullptr;
}

bool LoadedObject::contains(const void* address) const {
    const auto at = reinterpret_cast<ElfW(Addr)>(address);
    for (size_t i = 0; i < segmentCount_; ++i) {
        const ElfW(Addr) begin = base_ + segments_[i].p_vaddr;
        if (segments_[i].p_type == PT_LOAD && at >= begin && at - begin < segments_[i].p_memsz) return true;
    }
    return false;
}

bool LoadedObject::defines(uint32_t symbol, const char* name) const {
    const ElfW(Sym)& s = symbols_[symbol];
    return s.st_shndx != SHN_UNDEF && ELF64_ST_TYPE(s.st_info) == STT_FUNC && !std::strcmp(strings_ + s.st_name, name);
}

// Returns the number of the symbol; 0: none. A default version takes precedence over older ones of the same name.
uint32_t LoadedObject::findByGnuHash(const char* name) const {
    uint32_t hash = 5381, found = 0;
    for (const char* c = name; *c; ++c) hash = hash * 33 + static_cast<unsigned char>(*c);
    const uint32_t bucketCount = gnuHash_[0], firstSymbol = gnuHash_[1], filterWords = gnuHash_[2];
    const auto* buckets = gnuHash_ + 4 + filterWords * (sizeof(ElfW(Addr)) / sizeof(uint32_t));
    const uint32_t* chain = buckets + bucketCount;
    uint32_t i = bucketCount ? buckets[hash % bucketCount] : 0;
    if (i < firstSymbol || i == 0) return 0;
    for (;; ++i) {
        const uint32_t other = chain[i - firstSymbol];
        if ((other | 1) == (hash | 1) && defines(i, name)) {
            if (isDefault(i)) return i;
            found = i;
        }
        if (other & 1) return found;
    }
}

// The same with the older table; some linkers write only this one.
uint32_t LoadedObject::findByHash(const char* name) const {
    uint32_t hash = 0, found = 0;
    for (const char* c = name; *c; ++c) {
        hash = (hash << 4) + static_cast<unsigned char>(*c);
        const uint32_t high = hash & 0xf0000000U;
        hash = (hash ^ (high >> 24)) & ~high;
    }
    const uint32_t bucketCount = hash_[0];
    const uint32_t *buckets = hash_ + 2, *chain = buckets + bucketCount;
    for (uint32_t i = bucketCount ? buckets[hash % bucketCount] : 0; i != 0; i = chain[i]) {
        if (!defines(i, name)) continue;
        if (isDefault(i)) return i;
        found = i;
    }
    return found;
}

void* LoadedObject::function(const char* name) const {
    if (!strings_ || !symbols_ || (!gnuHash_ && !hash_)) return nullptr;
    const uint32_t symbol = gnuHash_ ? findByGnuHash(name) : findByHash(name);
    return symbol ? reinterpret_cast<void*>(base_ + symbols_[symbol].st_value) : nullptr;
}

} // namespace mural::loader
