// Determines from the header of an executable whether the dynamic loader starts it. Only such programs accept a
// preloaded library. Reads files without executing them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::launch {

enum class FileKind {
    Elf,         // a program for some machine
    Script,      // "#!": an interpreter runs it
    PlainScript, // text without "#!": /bin/sh runs it, as in a shell
    Unknown,     // not executable
};

struct ExecutableFacts {
    FileKind kind = FileKind::Unknown;
    int bits = 0;                  // ELF: 32 or 64
    uint16_t machine = 0;          // ELF: e_machine
    bool hasInterpreter = false;   // ELF: dynamically linked (PT_INTERP)
    std::string interpreter;       // ELF: path of the loader
    std::string scriptInterpreter; // Script: path after "#!"
    std::string scriptArgument;    // Script: the argument after the path, may be empty
};

Result<ExecutableFacts> readExecutable(const std::string& path);

// The dynamic section of a shared library.
struct LibraryFacts {
    std::string soname; // empty: none
    std::vector<std::string> needed;
};

// Supports libraries of this machine's word size.
Result<LibraryFacts> readLibrary(const std::string& path);

// The word size of this process. Mural captures only programs of the same machine type.
int ownBits();
uint16_t ownMachine();

} // namespace mural::launch
