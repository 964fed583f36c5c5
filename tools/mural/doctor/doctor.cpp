// `mural doctor`: runs all checks of this machine and prints them.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "tools/mural/doctor/check_report.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/doctor/doctor_checks.hpp"

namespace mural::cli {

namespace {

std::vector<Check> allChecks() {
    std::vector<Check> checks{checkVersions(), checkCaptureLibrary(), checkPreload()};
    bool draws = false;
    const auto gl = checkGl(draws);
    checks.insert(checks.end(), gl.begin(), gl.end());
    if (!draws)
        checks.push_back({Health::Bad, "GL", "no GL of this machine can draw",
                          "install Debian's package libegl-mesa0 or the graphics driver's"});
    for (const auto check : {checkDisplay, checkPrivateDisplay, checkSharedMemory, checkMemoryFolder, checkOpenFiles,
                             checkVideo, checkRemote}) {
        checks.push_back(check());
    }
    return checks;
}

} // namespace

int doctorCommand(bool asJson) {
    const std::vector<Check> checks = allChecks();
    const bool good = usable(checks);
    if (asJson) {
        const nlohmann::json all = {{"usable", good}, {"checks", toJson(checks)}};
        fmt::print("{}\n", jsonText(all, 2));
    } else {
        printChecks(checks);
        fmt::print("{}\n", good ? "Mural can be used on this machine."
                                : "Mural cannot be used on this machine yet: fix the lines that begin with \"bad\".");
    }
    return good ? 0 : 1;
}

} // namespace mural::cli
