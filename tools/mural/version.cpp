// `mural version`: the version of this build.
#include <fmt/format.h>

#include "tools/mural/commands.hpp"

namespace mural::cli {

const char* muralVersion() { return MURAL_VERSION; }

std::string versionText() { return fmt::format("mural {}", muralVersion()); }

int versionCommand() {
    fmt::print("{}\n", versionText());
    return 0;
}

int verboseVersionCommand(const std::vector<std::pair<std::string, std::string>>& details) {
    versionCommand();
    for (const auto& [name, text] : details) fmt::print("{:<12}{}\n", name, text);
    return 0;
}

} // namespace mural::cli
