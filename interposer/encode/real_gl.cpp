#include "interposer/encode/real_gl.hpp"

#include "interposer/encode/wrapper_table.hpp"

namespace mural {

GlFunctions gReal{};

namespace {
Loader realLoader = nullptr;
} // namespace

void setRealLoader(Loader loader) { realLoader = loader; }

Entry wrapperFor(const char* name) {
    const int index = glFunctionIndex(name);
    if (index < 0 || !realLoader) return nullptr;
    Entry real = realLoader(name);
    if (!real) return nullptr;
    // An alias may be another function in some APIs (glAttachObjectARB has no effect in ES).
    if (const Entry leading = realLoader(glFunctionName(index))) real = leading;
    auto* slot = reinterpret_cast<Entry*>(&gReal) + index;
    if (!__atomic_load_n(slot, __ATOMIC_ACQUIRE)) __atomic_store_n(slot, real, __ATOMIC_RELEASE);
    const Entry wrapper = wrapperAt(index);
    return wrapper ? wrapper : real;
}

} // namespace mural
