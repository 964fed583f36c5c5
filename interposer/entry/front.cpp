#include "interposer/entry/front.hpp"

#include <cstring>

#include "interposer/diagnostics/native_count.hpp"

namespace mural {

namespace {
int takenWay = static_cast<int>(Way::Open);
} // namespace

bool claimProgram(Way way) {
    int expected = static_cast<int>(Way::Open);
    const int wanted = static_cast<int>(way);
    return __atomic_compare_exchange_n(&takenWay, &expected, wanted, false, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE) ||
           expected == wanted;
}

void Front::attach(Loader library) {
    library_ = library;
    setRealLoader(library);
}

Entry Front::replacementFor(const char* name) const {
    for (size_t i = 0; i < count_; ++i) {
        if (!std::strcmp(own_[i].name, name)) return behind(name) ? own_[i].entry : nullptr;
    }
    if (nativeRun() || !std::strncmp(name, windowSystem_, 3) || std::strncmp(name, "gl", 2)) return nullptr;
    return wrapperFor(name);
}

Entry Front::entryFor(const char* name) const {
    if (const Entry ours = replacementFor(name)) return ours;
    return behind(name);
}

} // namespace mural
