#include "nodes/launch/program_check.hpp"

#include <cerrno>
#include <cstring>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include "nodes/launch/elf_check.hpp"

namespace mural::launch {

namespace {

constexpr int kMaxScriptDepth = 5; // the kernel's limit for "#!"

bool isFile(const std::string& path, struct stat& facts) {
    return stat(path.c_str(), &facts) == 0 && !S_ISDIR(facts.st_mode);
}

ProgramCheck failure(const std::string& path, int status, std::string message) {
    return {path, {}, status, std::move(message)};
}

ProgramCheck verifyFile(const std::string& name, const std::string& path) {
    struct stat facts {};
    if (stat(path.c_str(), &facts) != 0) {
        return failure(path, kExitNotFound, name + ": " + std::strerror(errno) + "; check the path of the program");
    }
    if (S_ISDIR(facts.st_mode)) {
        return failure(path, kExitNotExecutable, name + " is a folder; give the program inside it");
    }
    if (access(path.c_str(), X_OK) != 0) {
        return failure(path, kExitNotExecutable, name + " is not executable; run: chmod +x " + path);
    }
    return {path, {}, 0, {}};
}

bool hasFileCapabilities(const std::string& path) {
    return getxattr(path.c_str(), "security.capability", nullptr, 0) > 0;
}

// Returns why the loader would not preload the capture library into this program. Empty: it would.
std::string loaderObstacle(const std::string& path, const ExecutableFacts& facts) {
    struct stat file {};
    if (stat(path.c_str(), &file) != 0) return {};
    if ((file.st_mode & S_ISUID) != 0 || (file.st_mode & S_ISGID) != 0) {
        return path + " is a " + ((file.st_mode & S_ISUID) != 0 ? "setuid" : "setgid") +
               " program, for which the loader ignores LD_PRELOAD; run a copy without that bit";
    }
    if (getuid() != 0 && hasFileCapabilities(path)) {
        return path + " has file capabilities, so the loader ignores LD_PRELOAD; run a copy without them";
    }
    if (facts.bits != ownBits()) {
        return path + " is a " + std::to_string(facts.bits) + "-bit program, but this is the " +
               std::to_string(ownBits()) + "-bit Mural; install the program's " + std::to_string(ownBits()) +
               "-bit build";
    }
    if (facts.machine != ownMachine()) {
        return path + " is built for another processor (ELF machine " + std::to_string(facts.machine) +
               "); install this machine's build";
    }
    if (!facts.hasInterpreter) {
        return path + " is statically linked, so no library can be preloaded; use a dynamically linked build";
    }
    return {};
}

} // namespace

ProgramCheck findProgram(const std::string& name, const std::string& searchPath) {
    if (name.empty()) return failure(name, kExitNotFound, "the program's name is empty; add it after --");
    if (name.find('/') != std::string::npos) return verifyFile(name, name);
    std::string blocked;
    size_t at = 0;
    while (at <= searchPath.size()) {
        const size_t end = std::min(searchPath.find(':', at), searchPath.size());
        const std::string folder = searchPath.substr(at, end - at);
        const std::string path = (folder.empty() ? "." : folder) + "/" + name;
        struct stat facts {};
        if (isFile(path, facts)) {
            if (access(path.c_str(), X_OK) == 0) return {path, {}, 0, {}};
            if (blocked.empty()) blocked = path;
        }
        at = end + 1;
    }
    if (!blocked.empty()) return verifyFile(name, blocked);
    return failure(name, kExitNotFound, name + " was not found in PATH; install it or give its full path");
}

ProgramCheck checkProgram(const std::string& name, const std::string& searchPath) {
    ProgramCheck found = findProgram(name, searchPath);
    if (!found.ok()) return found;
    std::string path = found.path;
    for (int depth = 0; depth < kMaxScriptDepth; ++depth) {
        const auto facts = readExecutable(path);
        if (!facts.ok()) return found; // executable but not readable: the kernel decides
        switch (facts.value().kind) {
        case FileKind::Elf: {
            const std::string obstacle = loaderObstacle(path, facts.value());
            if (!obstacle.empty()) return failure(found.path, kExitUsage, obstacle);
            found.binary = path;
            return found;
        }
        case FileKind::Script: {
            const ProgramCheck next = verifyFile(facts.value().scriptInterpreter, facts.value().scriptInterpreter);
            if (!next.ok())
                return failure(found.path, next.exitStatus, path + " requests the interpreter " + next.message);
            path = next.path;
            break;
        }
        case FileKind::PlainScript: path = "/bin/sh"; break;
        case FileKind::Unknown:
            return failure(found.path, kExitNotExecutable, path + " is neither a program nor a script; check the file");
        }
    }
    return failure(found.path, kExitNotExecutable,
                   name + " is a chain of more than " + std::to_string(kMaxScriptDepth) +
                       " scripts; run the last one directly");
}

} // namespace mural::launch
