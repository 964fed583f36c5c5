#include "tools/mural/run/prepare_run.hpp"

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

void createSessionSocket(PreparedRun& run) {
    auto socket =
        launch::SessionSocket::create(run.config.session, run.programEnvironment.get("XDG_RUNTIME_DIR").value_or(""));
    if (!socket) return;
    run.socket = std::move(socket.value());
    run.config.socketPath = run.socket->path();
    run.programEnvironment.set("MURAL_SOCKET", run.config.socketPath);
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
    if (failed)
        return Error{
            fmt::format("--out {}: cannot create the folder: {}; choose another place", out, failed.message())};
    if (access(folder.c_str(), W_OK) != 0)
        return Error{fmt::format("--out {}: not writable: {}; choose another place", out, std::strerror(errno))};
    return {};
}

std::string earlierPictures(const std::string& out) {
    namespace fs = std::filesystem;
    const auto kind = outputKindOf(out);
    if (out.empty() || !kind.ok() || kind.value() == OutputKind::Video) return {};
    size_t count = 0;
    std::error_code failed;
    for (fs::directory_iterator at(out, failed), end; !failed && at != end; at.increment(failed)) {
        const std::string name = at->path().filename();
        count += name.starts_with("frame-") && name.ends_with(".png");
    }
    if (count == 0) return {};
    return fmt::format(
        "--out {}: the folder has {} picture{} of an earlier run; only frames with the same number are replaced", out,
        count, count == 1 ? "" : "s");
}

Result<void> checkResultFile(const std::string& option, const std::string& file) {
    namespace fs = std::filesystem;
    if (file.empty()) return {};
    std::error_code failed;
    const fs::path folder = fs::path(file).has_parent_path() ? fs::path(file).parent_path() : fs::path(".");
    if (fs::is_directory(file, failed)) return Error{option + " " + file + ": is a folder; give a file name"};
    const bool there = fs::exists(file, failed);
    if (access(there ? file.c_str() : folder.c_str(), W_OK) == 0) return {};
    return Error{fmt::format("{} {}: cannot be written: {}; choose another place", option, file, std::strerror(errno))};
}

Result<void> chooseDisplay(const RunOptions& options, bool programNeedsOne, PreparedRun& run) {
    SessionConfig& c = run.config;
    const std::string own = run.programEnvironment.get("DISPLAY").value_or("");
    const bool sized = c.width > 0;
    const bool usable = launch::displayUsable(own);
    const Error unusable{
        own.empty()
            ? "--display app and windows need an X display, but DISPLAY is not set; set it, or use --display none"
            : "the X display \"" + own +
                  "\" (DISPLAY) cannot be opened; check that it runs, or unset DISPLAY to run without one"};
    if (c.display == Display::Windows && !usable) return unusable;
    if (!options.displayChosen && !usable && !own.empty() && !sized) return unusable;
    if (options.displayChosen && c.display == Display::App && !usable && !sized) return unusable;
    const Display shown = programNeedsOne ? Display::App : Display::Windows; // by default, on a screen
    // A page needs pictures, and shows them with the dialogs and menus of the private display.
    const Display unseen = options.page.empty() ? Display::None : Display::App;
    if (!options.displayChosen) c.display = usable && !sized ? shown : unseen;

    c.displayName = own;
    if ((usable && !sized) || (!programNeedsOne && c.display == Display::None)) return {};
    auto display = launch::PrivateDisplay::start(sized ? c.width : launch::kDefaultScreenWidth,
                                                 sized ? c.height : launch::kDefaultScreenHeight);
    if (!display) return display.error();
    run.display = std::move(display.value());
    run.display->use(run.programEnvironment);
    if (c.display != Display::Windows) { // the wall's own windows belong on the user's display
        c.displayName = run.display->name();
        run.display->use(run.headEnvironment);
    }
    if (!sized) return {};
    auto manager =
        launch::WallWindowManager::open(run.display->name(), run.display->authority().cookie(), c.width, c.height);
    if (!manager) return manager.error();
    run.windowManager = std::move(manager.value());
    return {};
}

std::string unseenPictures(const RunOptions& options, const PreparedRun& run) {
    if (!options.displayChosen || run.config.display != Display::App || !run.display || !options.page.empty())
        return {};
    return "--display app: the program's window is on a private display of the wall's size (" + run.display->name() +
           "), which no screen shows; --display windows shows the wall, --out saves its pictures";
}

} // namespace mural::cli
