#include "transport/discovery/node_id.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <unistd.h>

#include <sodium.h>

#include "common/ipc/file_descriptor.hpp"
#include "transport/system_error.hpp"

namespace mural {

namespace {

constexpr size_t kMachineIdDigits = 32;
// Distinguishes Mural's hash of the machine id from other programs' hashes. Not secret.
constexpr std::string_view kPurpose = "mural: id of this machine's node";

std::string firstLine(const std::string& path) {
    std::string line;
    std::ifstream file(path);
    std::getline(file, line);
    return line;
}

std::optional<Uuid> fromMachineId(const std::string& path) {
    const std::string id = firstLine(path);
    // The file contains "uninitialized" until the first boot has finished.
    const auto isDigit = [](unsigned char c) { return std::isxdigit(c) != 0; };
    if (id.size() != kMachineIdDigits || !std::ranges::all_of(id, isDigit)) return {};
    static_assert(kPurpose.size() <= crypto_generichash_KEYBYTES_MAX &&
                  kPurpose.size() >= crypto_generichash_KEYBYTES_MIN);
    Uuid uuid{};
    crypto_generichash(reinterpret_cast<unsigned char*>(uuid.data()), uuid.size(),
                       reinterpret_cast<const unsigned char*>(id.data()), id.size(),
                       reinterpret_cast<const unsigned char*>(kPurpose.data()), kPurpose.size());
    return markedUuid(uuid);
}

std::string variable(const char* name) {
    const char* value = std::getenv(name); // NOLINT(concurrency-mt-unsafe): Mural's own processes change none
    return value ? value : "";
}

std::string stateFolder() {
    if (const std::string state = variable("XDG_STATE_HOME"); state.starts_with("/")) return state + "/mural";
    const std::string home = variable("HOME");
    return home.empty() ? "" : home + "/.local/state/mural";
}

// Two processes may run this at once: the file is written under a temporary name and linked, which only one can do.
Result<Uuid> storedId(const std::string& folder) {
    const std::string path = folder + "/node-id";
    if (const auto uuid = uuidFromText(firstLine(path))) return *uuid;
    const std::string advice = "; set XDG_STATE_HOME to a writable folder";
    std::error_code failed;
    if (!folder.empty()) std::filesystem::create_directories(folder, failed);
    if (folder.empty() || failed)
        return Error{"cannot store this machine's id: " +
                     (folder.empty() ? "HOME is not set" : folder + ": " + failed.message()) + advice};
    Uuid fresh{};
    randombytes_buf(fresh.data(), fresh.size());
    fresh = markedUuid(fresh);
    const std::string beside = path + "." + uuidText(fresh);
    {
        const FileDescriptor file(open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
        const std::string line = uuidText(fresh) + "\n";
        if (!file.valid() || write(file.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
            return Error{"cannot write " + beside + ": " + errnoText(errno) + advice};
    }
    if (link(beside.c_str(), path.c_str()) != 0 && errno == EEXIST && !uuidFromText(firstLine(path))) {
        // The existing file is invalid.
        (void)rename(beside.c_str(), path.c_str());
    }
    (void)unlink(beside.c_str());
    if (const auto uuid = uuidFromText(firstLine(path))) return *uuid;
    return Error{"cannot store this machine's id in " + path + advice};
}

} // namespace

Result<Uuid> nodeId(const NodeIdPlaces& places) {
    if (sodium_init() < 0) return Error{"libsodium cannot generate random numbers"};
    if (const auto uuid = fromMachineId(places.machineId)) return *uuid;
    return storedId(places.state.empty() ? stateFolder() : places.state);
}

} // namespace mural
