// The session's remote walls (mural run --send).
#include <algorithm>
#include <unistd.h>

#include "nodes/head/remote/remote_walls.hpp"
#include "nodes/head/session/head_session.hpp"

namespace mural {

// Called before programs connect, and therefore before the first picture.
Result<void> HeadSession::openRemoteWalls() {
    if (config_.sends.empty()) return {};
    remoteInput_ = std::make_unique<RemoteInput>([this] { return shownProgram(); }, getppid());
    auto opened = RemoteWalls::open(config_.sends, config_.launchSecret, currentPlan()->wall.stereo == StereoMode::Quad,
                                    *remoteInput_);
    if (!opened) return opened.error();
    remoteWalls_ = std::move(*opened);
    return {};
}

// The program whose picture the wall shows.
Result<ShownProgram> HeadSession::shownProgram() {
    const FrameTracker::ShownWindow shown = frames_.shownWindow();
    if (shown.client == 0) return Error{"no program draws at the moment; start one, or wait for its first frame"};
    ShownProgram result;
    result.client = shown.client;
    const auto programs = programs_->status();
    const auto program = std::ranges::find(programs, shown.client, &ProgramStatus::id);
    if (program != programs.end()) result.pid = program->pid;
    const auto window = nativeWindowOf(shown.client, 0, shown.native);
    if (window) result.display = window->display, result.window = window->id;
    return result;
}

} // namespace mural
