#include "tools/mural/prepare_run.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include "nodes/output/outputs.hpp"

namespace mural::cli {

std::string newSessionName() {
    uint64_t random = 0;
    if (getrandom(&random, sizeof random, 0) != sizeof random) random = static_cast<uint64_t>(monotonicNowNs());
    return fmt::format("mural-{}-{:016x}", getpid(), random);
}

Result<void> checkOutput(const std::string& out) {
    namespace fs = std::filesystem;
    if (out.empty()) return {};
    const auto kind = outputKindOf(out);
    if (!kind.ok()) return kind.error();
    const bool video = kind.value() == OutputKind::Video;
    const fs::path folder = video ? fs::path(out).parent_path() : fs::path(out);
    if (folder.empty()) return {};
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) return Error{fmt::format("--out {}: the folder cannot be made: {}; give another place", out, failed.message())};
    if (access(folder.c_str(), W_OK) != 0) return Error{fmt::format("--out {}: may not be written: {}; give another place", out, std::strerror(errno))};
    return {};
}

Result<void> chooseDisplay(const RunOptions& options, bool programNeedsOne, PreparedRun& run) {
    SessionConfig& c = run.config;
    const std::string own = run.programEnvironment.get("DISPLAY").value_or("");
    const bool sized = c.width > 0;
    const bool usable = launch::displayUsable(own);
    const Error unusable{own.empty() ? "--display app and windows need an X display, and DISPLAY is not set; set it, or use --display none"
                                     : "the X display \"" + own + "\" (DISPLAY) cannot be opened; check that it runs, or unset DISPLAY to run without one"};
    if (c.display == Display::Windows && !usable) return unusable;
    if (!options.displayChosen && !usable && !own.empty() && !sized) return unusable;
    if (options.displayChosen && c.display == Display::App && !usable && !sized) return unusable;
    if (!options.displayChosen) c.display = usable && !sized ? Display::App : Display::None;

    c.displayName = own;
    if ((usable && !sized) || (!programNeedsOne && c.display == Display::None)) return {};
    auto display = launch::PrivateDisplay::start(sized ? c.width : launch::kDefaultScreenWidth, sized ? c.height : launch::kDefaultScreenHeight);
    if (!display) return display.error();
    run.display = std::move(display.value());
    run.display->use(run.programEnvironment);
    if (c.display != Display::Windows) { // the wall's own windows belong on the user's display
        c.displayName = run.display->name();
        run.display->use(run.headEnvironment);
    }
    if (!sized) return {};
    auto manager = launch::WallWindowManager::open(run.display->name(), run.display->authority().cookie(), c.width, c.height);
    if (!manager) return manager.error();
    run.windowManager = std::move(manager.value());
    return {};
}

std::string unseenPictures(const RunOptions& options, const PreparedRun& run) {
    if (!options.displayChosen || run.config.display != Display::App || !run.display) return {};
    return "--display app: the program's window is on a private display of the wall's size (" + run.display->name() +
           "), where nobody sees the picture in it; --display windows shows the wall, --out keeps its pictures";
}

} // namespace mural::cli
