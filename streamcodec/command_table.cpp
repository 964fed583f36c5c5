#include "streamcodec/command_table.hpp"

#include <algorithm>

namespace mural {
namespace {
// The element with this name, or null. The table is sorted.
template <class T> const T* find(std::span<const T> table, std::string_view name) {
    const auto it = std::lower_bound(table.begin(), table.end(), name,
                                     [](const T& e, std::string_view n) { return std::string_view(e.name) < n; });
    return it != table.end() && it->name == name ? &*it : nullptr;
}
} // namespace

const CommandInfo* findCommand(std::string_view name) { return find(commandTable(), name); }

bool extensionCarried(std::string_view name) {
    const ExtensionInfo* e = find(extensionTable(), name);
    return !e || e->supported;
}

const char* registeredExtension(std::string_view name) {
    const ExtensionInfo* e = find(extensionTable(), name);
    return e ? e->name : nullptr;
}

} // namespace mural
