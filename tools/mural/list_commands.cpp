// `mural list-commands`: prints the GL commands that the stream supports and the others with reasons.
#include <fmt/format.h>

#include "streamcodec/command_table.hpp"
#include "streamcodec/local_extensions.hpp"
#include "tools/mural/commands.hpp"

namespace mural::cli {

int listCommandsCommand(bool onlyUnsupported) {
    int64_t supported = 0;
    int64_t unsupported = 0;
    for (const CommandInfo& command : commandTable()) {
        (command.supported ? supported : unsupported) += 1;
        if (onlyUnsupported && command.supported) continue;
        fmt::print("{}\t{}{}{}\n", command.name, command.commandClass, *command.reason != '\0' ? "\t" : "",
                   command.reason);
    }
    if (onlyUnsupported)
        for (const LocalExtension& e : kLocalWindowExtensions) fmt::print("{}\textension\t{}\n", e.name, e.why);
    fmt::print(stderr, "mural: {} commands supported, {} unsupported\n", supported, unsupported);
    return 0;
}

} // namespace mural::cli
