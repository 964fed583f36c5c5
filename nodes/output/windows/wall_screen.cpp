#include "nodes/output/windows/wall_screen.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>

#include "common/base/clock.hpp"

namespace mural {

Result<std::unique_ptr<WallScreen>> WallScreen::open(const WallWindowsConfig& config) {
    std::unique_ptr<WallScreen> screen(new WallScreen(config));
    Result<std::unique_ptr<GlfwSession>> session = GlfwSession::open(config.displayName);
    if (!session) return session.error();
    screen->session_ = std::move(session.value());
    if (config.stereo) {
        const Result<void> opened = screen->openWindows(true, true);
        screen->stereo_ = opened.ok();
        if (opened) return screen;
        screen->whyNotStereo_ = opened.error().message;
    }
    const bool automatic = config.drawing == WallDrawing::Auto;
    const bool openGl = automatic ? WallWindow::openGlIsFast(*screen->session_) : config.drawing == WallDrawing::OpenGl;
    Result<void> opened = screen->openWindows(openGl, false);
    if (!opened && automatic && openGl) opened = screen->openWindows(false, false);
    if (!opened) return opened.error();
    return screen;
}

Result<void> WallScreen::openWindows(bool openGl, bool stereo) {
    windows_.clear();
    for (size_t i = 0; i < config_.tiles.size(); ++i) {
        const TileWindow& tile = config_.tiles[i];
        WallWindow::Options options;
        options.place = placeOf(tile);
        options.title = tile.title;
        options.fullScreen = config_.fullScreen;
        options.monitor = tile.monitor >= 0 ? tile.monitor : static_cast<int>(i);
        options.openGl = openGl;
        options.stereo = stereo;
        // Only one swap waits for the refresh: several waits would add up.
        options.waitForRefresh = config_.waitForRefresh && i == 0;
        options.timeoutMs = config_.showTimeoutMs;
        options.overlay = config_.overlay;
        options.onWall = onWall(tile);
        options.onInput = config_.onInput;
        options.hasBorders = config_.hasBorders;
        Result<std::unique_ptr<WallWindow>> window = WallWindow::open(*session_, options);
        if (!window) return window.error();
        windows_.push_back(std::move(window.value()));
    }
    return checkDisplay();
}

// Upper left corner and size, y down as on the screen.
PixelViewport WallScreen::placeOf(const TileWindow& tile) const {
    return {tile.screenX + config_.positionX, tile.screenY + config_.positionY, tile.tile.w, tile.tile.h};
}

OverlayPlace WallScreen::onWall(const TileWindow& tile) const {
    OverlayPlace place = config_.wall;
    place.title = tile.title;
    place.part = tile.tile;
    return place;
}

Result<void> WallScreen::checkDisplay() const {
    if (session_->sync()) return {};
    return Error{fmt::format("the connection to the X display '{}' is lost; restart its server and "
                             "the session",
                             session_->displayName())};
}

Result<void> WallScreen::draw(std::vector<TileBuffer>& buffers) {
    drawn_.clear();
    if (Result<void> there = checkDisplay(); !there) return there;
    for (TileBuffer& buffer : buffers) {
        if (Result<void> drawn = windows_[buffer.tile]->draw(buffer.picture, buffer.right); !drawn) return drawn;
        drawn_.push_back(buffer.tile);
    }
    return {};
}

Result<void> WallScreen::present(int64_t atNs) {
    sleepUntilNs(atNs);
    for (const size_t tile : drawn_)
        if (Result<void> shown = windows_[tile]->present(); !shown) return shown;
    for (const size_t tile : drawn_) windows_[tile]->finish();
    presentedNs_ = monotonicNowNs();
    drawn_.clear();
    return checkDisplay();
}

Result<void> WallScreen::arrange(const std::vector<TileWindow>& tiles) {
    if (Result<void> there = checkDisplay(); !there) return there;
    config_.tiles = tiles;
    for (size_t i = 0; i < windows_.size(); ++i)
        if (Result<void> moved = windows_[i]->move(placeOf(tiles[i]), onWall(tiles[i])); !moved) return moved;
    return checkDisplay();
}

Result<void> WallScreen::doWork() {
    if (session_->displayLost()) return checkDisplay();
    session_->guardErrors();
    glfwPollEvents();
    if (!drawn_.empty()) return {}; // present() shows the drawn pictures, at its time
    for (const auto& window : windows_)
        if (Result<void> redrawn = window->redrawIfNeeded(); !redrawn) return redrawn;
    return {};
}

bool WallScreen::closeRequested() const {
    for (const auto& window : windows_)
        if (window->closeRequested()) return true;
    return false;
}

std::string WallScreen::describe() const {
    return fmt::format("{} window{} on {} ({})", windows_.size(), windows_.size() == 1 ? "" : "s",
                       session_->displayName(), windows_.front()->drawnBy());
}

} // namespace mural
