// The session's remote walls (mural run --send), and input of windows for the program.
#include <algorithm>
#include <unistd.h>

#include "nodes/head/remote/remote_walls.hpp"
#include "nodes/head/session/head_session.hpp"

namespace mural {

// Called before programs connect, and therefore before the first window.
void HeadSession::openWallInput() {
    const bool hasWindows = config_.display == Display::Windows && config_.windowInput != input::InputPermission::Off;
    if (hasWindows || !config_.sends.empty())
        wallInput_ = std::make_unique<WallInput>([this] { return shownProgram(); }, getppid());
}

void HeadSession::takeWindowInput(const input::InputEvent& event) {
    if (!wallInput_ || config_.windowInput == input::InputPermission::Off) return;
    wallInput_->take({"the wall windows", "--window-input display", config_.windowInput}, event);
}

Result<void> HeadSession::nodeWindowInput(int, const input::InputEvent& event) {
    takeWindowInput(event);
    return {};
}

WallPlace HeadSession::wallPlace(int offsetX, const CanvasMillimetres& size) {
    WallPlace place{offsetX, size, {}};
    if (config_.windowInput != input::InputPermission::Off)
        place.onInput = [this](const input::InputEvent& event) { takeWindowInput(event); };
    return place;
}

// Called before programs connect, and therefore before the first picture.
Result<void> HeadSession::openRemoteWalls() {
    if (config_.sends.empty()) return {};
    auto opened = RemoteWalls::open(config_.sends, config_.launchSecret, currentPlan()->wall.stereo == StereoMode::Quad,
                                    *wallInput_);
    if (!opened) return opened.error();
    remoteWalls_ = std::move(*opened);
    return {};
}

// The program whose picture the wall shows. Before the first frame: the first program, which may show a dialog.
Result<ShownProgram> HeadSession::shownProgram() {
    const FrameTracker::ShownWindow shown = frames_.shownWindow();
    const auto programs = programs_->status();
    ShownProgram result;
    if (shown.client == 0 && !programs.empty()) {
        result.client = programs.front().id;
        result.pid = programs.front().pid;
        return result;
    }
    if (shown.client == 0) return Error{"no program draws at the moment; start one, or wait for its first frame"};
    result.client = shown.client;
    const auto program = std::ranges::find(programs, shown.client, &ProgramStatus::id);
    if (program != programs.end()) result.pid = program->pid;
    const auto window = nativeWindowOf(shown.client, 0, shown.native);
    if (window) result.display = window->display, result.window = window->id;
    return result;
}

} // namespace mural
