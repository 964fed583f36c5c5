#include "interposer/draw_opcodes.hpp"

#include <cstring>

#include "streamcodec/command_table.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

namespace {
constexpr uint32_t kOpcodes = 65536;
bool draws[kOpcodes];
bool known = false;

// Filled by whoever asks first; two threads at once write the same.
void learn() {
    for (const CommandInfo& c : commandTable()) {
        const bool drawn = std::strcmp(c.commandClass, "draw") == 0 || std::strncmp(c.name, "glCopyTex", 9) == 0;
        if (c.opcode != 0 && drawn) draws[c.opcode] = true;
    }
    draws[wire::kOpClientArrays] = true;
    __atomic_store_n(&known, true, __ATOMIC_RELEASE);
}
} // namespace

bool drawsIntoWindow(uint32_t opcode) {
    if (!__atomic_load_n(&known, __ATOMIC_ACQUIRE)) learn();
    return opcode < kOpcodes && draws[opcode];
}

} // namespace mural
