// Checks of `mural doctor`, one function each. Each returns in bounded time.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace mural::cli {

enum class Health { Ok, Warn, Bad };

struct Check {
    Health health = Health::Ok;
    std::string name;
    std::string found;
    std::string advice; // next step; empty if fine
};

Check checkVersions();
Check checkCaptureLibrary();
Check checkPreload();
Check checkDisplay();
Check checkPrivateDisplay();
Check checkSharedMemory();
Check checkMemoryFolder();
Check checkOpenFiles();
Check checkVideo();
Check checkRemote();
// One check per GL backend. Sets `usable` if at least one can draw.
std::vector<Check> checkGl(bool& usable);

// Runs `work` in a child process, so a driver's crash or hang does no harm. Returns its text, or the problem.
struct Isolated {
    bool ok = false;
    std::string text;
};
Isolated inChild(const std::function<Isolated()>& work, int64_t limitMs);

} // namespace mural::cli
