#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tools/mural/commands.hpp"
#include "tools/mural/doctor_checks.hpp"

namespace mural::cli {

namespace {

const char* word(Health health) {
    switch (health) {
    case Health::Ok: return "ok";
    case Health::Warn: return "warn";
    case Health::Bad: return "bad";
    }
    return "bad";
}

std::vector<Check> allChecks() {
    std::vector<Check> checks{checkVersions(), checkCaptureLibrary(), checkPreload()};
    bool draws = false;
    const auto gl = checkGl(draws);
    checks.insert(checks.end(), gl.begin(), gl.end());
    if (!draws) checks.push_back({Health::Bad, "GL", "no GL of this machine draws", "install Debian's package libegl-mesa0 or the graphics driver's"});
    for (const auto check : {checkDisplay, checkPrivateDisplay, checkSharedMemory, checkMemoryFolder, checkOpenFiles, checkVideo, checkRemote}) {
        checks.push_back(check());
    }
    return checks;
}

void printLines(const std::vector<Check>& checks, bool usable) {
    for (const Check& c : checks) {
        fmt::print("{:<5}{:<17}{}{}{}\n", word(c.health), c.name, c.found, c.advice.empty() ? "" : " -> ", c.advice);
    }
    fmt::print("{}\n", usable ? "Mural can be used on this machine." : "Mural cannot be used on this machine yet: mend the lines that begin with \"bad\".");
}

void printJson(const std::vector<Check>& checks, bool usable) {
    nlohmann::json list = nlohmann::json::array();
    for (const Check& c : checks) {
        list.push_back({{"health", word(c.health)}, {"name", c.name}, {"found", c.found}, {"advice", c.advice}});
    }
    const nlohmann::json all = {{"usable", usable}, {"checks", list}};
    fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

} // namespace

int doctorCommand(bool asJson) {
    const std::vector<Check> checks = allChecks();
    bool usable = true;
    for (const Check& c : checks) usable = usable && c.health != Health::Bad;
    if (asJson) {
        printJson(checks, usable);
    } else {
        printLines(checks, usable);
    }
    return usable ? 0 : 1;
}

} // namespace mural::cli
