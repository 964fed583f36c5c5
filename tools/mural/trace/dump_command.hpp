// `mural dump`: prints a trace as text.
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace mural::cli {

struct DumpArguments {
    std::string file;
    std::optional<std::string> frames, calls;
    bool summary = false;
};

void describeDump(CLI::App& command, DumpArguments& arguments);
int dumpCommand(const DumpArguments& arguments);

} // namespace mural::cli
