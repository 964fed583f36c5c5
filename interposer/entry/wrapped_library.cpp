#include "interposer/entry/wrapped_library.hpp"

#include <cstring>

#include "interposer/diagnostics/native_count.hpp"

namespace mural {

namespace {
int activeEntry = static_cast<int>(EntryKind::Unclaimed);
} // namespace

bool claimProgram(EntryKind kind) {
    int expected = static_cast<int>(EntryKind::Unclaimed);
    const int wanted = static_cast<int>(kind);
    return __atomic_compare_exchange_n(&activeEntry, &expected, wanted, false, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE) ||
           expected == wanted;
}

void WrappedLibrary::attach(Loader library) {
    library_ = library;
    setRealLoader(library);
}

Entry WrappedLibrary::replacementFor(const char* name) const {
    for (size_t i = 0; i < count_; ++i) {
        if (!std::strcmp(own_[i].name, name)) return behind(name) ? own_[i].entry : nullptr;
    }
    if (nativeRun() || !std::strncmp(name, windowSystem_, 3) || std::strncmp(name, "gl", 2)) return nullptr;
    return wrapperFor(name);
}

Entry WrappedLibrary::entryFor(const char* name) const {
    if (const Entry replacement = replacementFor(name)) return replacement;
    return behind(name);
}

} // namespace mural
