// What `mural doctor` looks at, one function per thing. Each returns in limited time.
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
    std::string advice; // what to do; empty when fine
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
// One for each backend; usable is set when at least one draws.
std::vector<Check> checkGl(bool& usable);

// Runs `work` in a child process, so that a driver that crashes or hangs does no harm here; its text,
// or what happened instead.
struct Isolated {
    bool ok = false;
    std::string text;
};
Isolated inChild(const std::function<Isolated()>& work, int64_t limitMs);

} // namespace mural::cli
