// The last component of a path.
#pragma once

#include <string_view>

namespace mural::launch {

inline std::string_view baseName(std::string_view path) {
    const auto slash = path.rfind('/');
    return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

} // namespace mural::launch
