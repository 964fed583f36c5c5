// Every command and extension of the registry, and whether Mural carries it. Sorted by name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace mural {

struct CommandInfo {
    const char* name;
    const char* commandClass; // state object draw query sync transfer frame unsupported
    const char* reason;       // why it is not carried; empty otherwise
    bool carried;
    uint16_t opcode;          // 0: never in a stream
};
struct ExtensionInfo {
    const char* name;
    bool carried;             // all its commands are; else it is not advertised to programs
    const char* firstLacking;
};

std::span<const CommandInfo> commandTable();
std::span<const ExtensionInfo> extensionTable();
const CommandInfo* findCommand(std::string_view name);
// Extensions that the registry does not know bring no commands that it knows: they change what
// carried commands accept, and count as carried.
bool extensionCarried(std::string_view name);
// The registry's own text of that name, there for ever; null: it knows none.
const char* registeredExtension(std::string_view name);

} // namespace mural
