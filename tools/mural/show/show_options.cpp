#include "tools/mural/show/show_options.hpp"

#include <array>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "nodes/launch/environment.hpp"
#include "nodes/launch/private_display.hpp"
#include "nodes/output/outputs.hpp"
#include "nodes/output/windows/wall_layout.hpp"
#include "tools/mural/run/option_values.hpp"
#include "tools/mural/show/config_windows.hpp"
#include "transport/rsp/group_text.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::cli {

namespace {

constexpr int kMaxScreenOffset = 1 << 15;

std::string ownMachine() {
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == 0) return "wall";
    return name.data();
}

Result<void> readListen(const ShowArguments& a, remote::WallReceiverConfig& receiver) {
    if (a.listen.empty()) return Error{"--listen [HOST:]PORT is required, such as --listen 4281"};
    const bool isPort = a.listen.find(':') == std::string::npos;
    const auto where = splitHostPort(isPort ? ":" + a.listen : a.listen);
    if (!where) return badValue("--listen", a.listen, "must be [HOST:]PORT, such as 4281 or 10.0.0.5:4281");
    receiver.host = where->host;
    receiver.port = where->port;
    if (a.secretFile.empty())
        return Error{"--secret FILE is required; it has the secret that the sender proves (mural run --secret)"};
    auto secret = rsp::readSecret(a.secretFile);
    if (!secret) return Error{"--secret: " + secret.error().message};
    receiver.secret = *secret;
    receiver.name = a.name.empty() ? ownMachine() : a.name;
    receiver.limits.rate = a.rate;
    return {};
}

// Selects the windows. Without a display, pictures can only be saved.
Result<void> readWindows(const ShowArguments& a, ShowOptions& options) {
    const std::string display = launch::Environment::current().get("DISPLAY").value_or("");
    if (!a.display.empty() && a.display != "windows" && a.display != "none")
        return badValue("--display", a.display, "must be windows or none");
    const bool isUsable = launch::displayUsable(display);
    options.hasWindows = a.display.empty() ? isUsable : a.display == "windows";
    if (options.hasWindows && !isUsable)
        return Error{"--display windows needs an X display; set DISPLAY to a running one, or add --display none"};
    if (!options.hasWindows && options.outs.empty())
        return Error{"nothing would show the pictures; set DISPLAY for a window, or add --out"};
    if (!options.hasWindows && (a.isFullScreen || !a.position.empty()))
        return Error{std::string(a.isFullScreen ? "--fullscreen" : "--position") +
                     " needs windows; omit it, or use --display windows"};
    options.windows.displayName = display;
    options.windows.fullScreen = options.windows.fullScreen || a.isFullScreen;
    if (a.position.empty()) return {};
    const auto position = pairOf(a.position, ',', -kMaxScreenOffset, kMaxScreenOffset);
    if (!position) return badValue("--position", a.position, "must be two numbers of pixels, such as 1920,0");
    options.windows.positionX = position->first;
    options.windows.positionY = position->second;
    return {};
}

Result<void> readWall(const ShowArguments& a, ShowOptions& options) {
    options.arrange = [](int width, int height) {
        auto windows = windowsOfTiles(TileGrid{1, 1, 1}, {0, 0, 1, 1}, width, height);
        windows.front().title = "Mural remote wall";
        return windows;
    };
    if (!a.size.empty() && !a.config.empty())
        return Error{"--size and --config both state the size of the wall; omit one of them"};
    if (!a.size.empty()) {
        const auto size = pairOf(a.size, 'x', 1, remote::kMaxPictureSide);
        if (!size) return badValue("--size", a.size, "must be two numbers up to 32767, such as 3840x2160");
        options.receiver.limits.width = size->first;
        options.receiver.limits.height = size->second;
    }
    if (a.config.empty()) return {};
    auto wall = configWindows(a.config);
    if (!wall) return wall.error();
    options.receiver.limits.width = wall->width;
    options.receiver.limits.height = wall->height;
    options.windows.fullScreen = wall->isFullScreen;
    options.windows.wall.wallWidthMm = 0;
    options.arrange = [w = *wall](int width, int height) { return windowsFor(w, width, height); };
    return {};
}

} // namespace

const char* const kShowFooter =
    R"(Examples:
  mural show --listen 4281 --secret key                       a window with the pictures of one sender
  mural show --listen 4281 --secret key --fullscreen
  mural show --listen 4281 --secret key --config wall.eqc     the windows of a configuration file
  mural show --listen 4281 --secret key --display none --out shots
  mural run --secret key --send museum=wall.example:4281 -- app
                                                              the sender, on another machine

Exit status: 0 after Ctrl-C or after its window is closed, 1 if it could not show pictures, 2 for a bad argument.)";

void describeShow(CLI::App& command, ShowArguments& a) {
    command.add_option("--listen", a.listen, "port that senders connect to, perhaps of one address of this machine")
        ->type_name("[HOST:]PORT");
    command.add_option("--secret", a.secretFile, "file with the secret that the sender proves")->type_name("FILE");
    command
        .add_option("--size", a.size,
                    "size of the wall; senders reduce larger pictures to it (the size of the pictures)")
        ->type_name("WxH");
    command.add_option("--config", a.config, "configuration file with the windows of the wall")->type_name("FILE");
    command
        .add_option("--display", a.display,
                    "windows: on this display; none: pictures are only saved (windows with a display)")
        ->type_name("WHERE");
    command.add_flag("--fullscreen", a.isFullScreen, "windows without borders, one per monitor");
    command.add_option("--position", a.position, "upper left corner of the windows on the screen")->type_name("X,Y");
    command
        .add_option("--out", a.outs,
                    "write the shown pictures into a folder (PNG), or a video (.mp4, .mkv, .webm, …); may be repeated")
        ->type_name("DIR|VIDEO")
        ->allow_extra_args(false)
        ->take_all();
    command.add_option("--rate", a.rate, "most pictures per second (the choice of the sender)")
        ->type_name("N")
        ->check(CLI::Range(1, remote::kMaxRate));
    command.add_option("--name", a.name, "name of this wall in the lines of the sender (the host name)")
        ->type_name("NAME");
}

Result<ShowOptions> showOptionsFrom(const ShowArguments& a) {
    ShowOptions options;
    options.outs = a.outs;
    for (const std::string& out : options.outs)
        if (const auto kind = outputKindOf(out); !kind) return kind.error();
    if (auto r = readListen(a, options.receiver); !r) return r.error();
    if (auto r = readWall(a, options); !r) return r.error();
    if (auto r = readWindows(a, options); !r) return r.error();
    return options;
}

} // namespace mural::cli
