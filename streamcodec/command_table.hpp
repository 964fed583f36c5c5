// All commands and extensions of the registry, and whether Mural supports them. Sorted by name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace mural {

struct CommandInfo {
    const char* name;
    const char* commandClass; // state object draw query sync transfer frame unsupported
    const char* reason;       // why it is unsupported; otherwise empty
    bool supported;
    uint16_t opcode; // 0: never in a stream
};
struct ExtensionInfo {
    const char* name;
    bool supported; // all of its commands are supported; otherwise it is hidden from programs
    const char* firstLacking;
};

std::span<const CommandInfo> commandTable();
std::span<const ExtensionInfo> extensionTable();
const CommandInfo* findCommand(std::string_view name);
// Extensions outside the registry add no commands: they only extend the arguments of supported commands, and count as
// supported.
bool extensionCarried(std::string_view name);
// The registry's copy of the name, with static lifetime; null: unknown.
const char* registeredExtension(std::string_view name);

} // namespace mural
