// The windows of a display wall on one X display: one borderless window per tile, at given places,
// or one full-screen window per monitor. Shows pictures pixel by pixel, upper left corners
// together.
//
// All windowing happens in a thread of this object's own, with OpenGL contexts of its own: the
// caller's current context is not touched. The calls here may come from any thread; each waits
// until the thread has done it, with a deadline. One WallWindows per process at a time (GLFW is one
// per process).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/pixel_viewport.hpp"
#include "common/result.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

struct TileWindow {
    PixelViewport tile; // in pixels of the wall, origin lower left
    int screenX = 0;    // upper left corner on the X screen, before WallWindowsConfig::position
    int screenY = 0;
    std::string title = "Mural";
    int monitor = -1; // full screen: in reading order of the monitors; -1: the tile's index
};

// Windows for tiles that lie on the screen as they do on the wall.
std::vector<TileWindow> placeTiles(std::span<const PixelViewport> tiles, int wallHeight);

// OpenGl is what graphics cards do best and what can wait for the refresh; XPut needs no OpenGL on
// the display and is faster where that runs on the CPU: 2 ms against 23 ms for 1920x1080 (llvmpipe,
// Xvfb, 2 cores). Auto takes OpenGl on a graphics card, XPut elsewhere. Both are exact on 24-bit
// screens.
enum class WallDrawing { Auto, OpenGl, XPut };

struct WallWindowsConfig {
    std::string displayName; // empty: DISPLAY
    std::vector<TileWindow> tiles;
    int positionX = 0; // --position: added to the place of every window
    int positionY = 0;
    bool fullScreen = false;
    WallDrawing drawing = WallDrawing::Auto;
    bool stereo = false; // windows with a buffer for each eye, where the display has them: by OpenGl then
    bool waitForRefresh = true; // OpenGl: swap at the monitor's refresh (once per showAll)
    int64_t openTimeoutMs = 20'000;
    int64_t showTimeoutMs = 5'000; // of show, showAll, arrange, and of closing
};

class WallWindows {
public:
    struct TilePicture {
        size_t tile = 0;
        Picture picture;    // of the left eye, where there are two
        Picture right = {}; // empty: the same for both
    };

    static Result<std::unique_ptr<WallWindows>> open(const WallWindowsConfig& config);
    WallWindows(const WallWindows&) = delete;
    WallWindows& operator=(const WallWindows&) = delete;
    ~WallWindows();

    // Returns when the server has the picture; its memory is the caller's again. A window that has
    // not the picture's size is given it (not in full screen).
    Result<void> show(size_t tile, const Picture& picture);

    // Draws all, then shows one directly after the other.
    Result<void> showAll(std::span<const TilePicture> pictures);

    // The same in two steps, between which other nodes may be waited for. `present` shows what was drawn last, not before
    // `atNs` (monotonicNowNs()), and returns when the server had it.
    Result<void> drawAll(std::span<const TilePicture> pictures);
    Result<int64_t> present(int64_t atNs);

    // The windows have a buffer for each eye.
    [[nodiscard]] bool stereo() const;
    // Why they don't, though that was wanted; else "".
    [[nodiscard]] std::string whyNotStereo() const;

    // Other places and sizes for the same number of tiles; pictures follow with the next show.
    Result<void> arrange(const std::vector<TileWindow>& tiles);

    // The user has asked a window to close.
    [[nodiscard]] bool closeRequested() const;

    [[nodiscard]] std::string describe() const; // e.g. "4 windows on :0 (OpenGL, llvmpipe)"

private:
    struct Shared;
    explicit WallWindows(std::shared_ptr<Shared> shared);
    Result<void> take(std::span<const TilePicture> pictures, bool present);

    std::shared_ptr<Shared> shared_; // with the thread
    int64_t showTimeoutMs_;
};

} // namespace mural
