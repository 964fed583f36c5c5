#include <fmt/format.h>

#include "tools/mural/commands.hpp"

namespace mural::cli {

const char* muralVersion() { return MURAL_VERSION; }

int versionCommand() {
    fmt::print("mural {}\n", muralVersion());
    return 0;
}

} // namespace mural::cli
