// Thread-safe text of an errno value; strerror is not thread-safe.
#pragma once

#include <string>
#include <system_error>

namespace mural {

inline std::string errnoText(int code) { return std::generic_category().message(code); }

} // namespace mural
