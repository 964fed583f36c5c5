// What the first bytes of an executable file say: is it a program that the dynamic loader starts?
// Only such programs take a preloaded library. Pure reading, no execution.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural::launch {

enum class FileKind {
    Elf,         // a program for some machine
    Script,      // "#!": another program runs it
    PlainScript, // text without "#!": /bin/sh runs it, as a shell would do
    Unknown,     // neither: nothing can run it
};

struct ExecutableFacts {
    FileKind kind = FileKind::Unknown;
    int bits = 0;                  // ELF: 32 or 64
    uint16_t machine = 0;          // ELF: e_machine
    bool hasInterpreter = false;   // ELF: the dynamic loader starts it (PT_INTERP)
    std::string interpreter;       // ELF: path of that loader
    std::string scriptInterpreter; // Script: path after "#!"
    std::string scriptArgument;    // Script: the one argument after the path, may be empty
};

Result<ExecutableFacts> readExecutable(const std::string& path);

// What the dynamic section of a shared library says.
struct LibraryFacts {
    std::string soname; // empty: none
    std::vector<std::string> needed;
};

// For libraries of this machine's word size.
Result<LibraryFacts> readLibrary(const std::string& path);

// Of this process: programs that Mural captures must be of the same machine.
int ownBits();
uint16_t ownMachine();

} // namespace mural::launch
