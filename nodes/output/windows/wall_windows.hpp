// The windows of a display wall on one X display: one borderless window per tile, or one full-screen window per
// monitor. Shows pictures pixel by pixel, aligned at the upper left corner.
//
// A separate thread owns the windows and their OpenGL contexts, so the caller's current context does not change. All
// calls are thread-safe, and wait for that thread with a deadline. One WallWindows per process at a time (GLFW is
// global).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "common/base/result.hpp"
#include "nodes/input/input_event.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/overlay/overlay.hpp"

namespace mural {

struct TileWindow {
    PixelViewport tile; // in pixels of the wall, origin lower left
    int screenX = 0;    // upper left corner on the X screen, without WallWindowsConfig::position
    int screenY = 0;
    std::string title = "Mural";
    int monitor = -1; // full screen: monitor in reading order; -1: the tile's index
};

// Arranges the windows on the screen as the tiles on the wall.
std::vector<TileWindow> placeTiles(std::span<const PixelViewport> tiles, int wallHeight);

// OpenGl suits graphics cards and can wait for the refresh. XPut needs no OpenGL and is faster with software rendering:
// 2 ms against 23 ms for 1920x1080 (llvmpipe, Xvfb, 2 cores). Auto selects OpenGl on a graphics card, otherwise XPut.
// Both are exact on 24-bit screens.
enum class WallDrawing { Auto, OpenGl, XPut };

// A change of the overlay's mode appears in windows without new pictures within this time, in ms.
inline constexpr int64_t kOverlayMs = 250;

struct WallWindowsConfig {
    std::string displayName; // empty: DISPLAY
    std::vector<TileWindow> tiles;
    int positionX = 0; // --position: offset of every window
    int positionY = 0;
    bool fullScreen = false;
    WallDrawing drawing = WallDrawing::Auto;
    bool stereo = false; // requests a buffer per eye, which needs OpenGl
    // Drawn over the pictures when they are shown; null: none. A change of its mode appears within kOverlayMs.
    std::shared_ptr<const Overlay> overlay;
    OverlayPlace wall; // the size of the wall; each window has its own title and part
    // Takes events of the windows, with places on the wall. Called by the windows' thread, which shows no picture
    // meanwhile. Empty: none.
    std::function<void(const input::InputEvent& event)> onInput;
    bool hasBorders = false;    // the user may move, resize and close the windows, which are focused when they open
    bool waitForRefresh = true; // OpenGl: swaps at the monitor's refresh (once per showAll)
    int64_t openTimeoutMs = 20'000;
    int64_t showTimeoutMs = 5'000; // for show, showAll, arrange, and closing
};

class WallWindows {
public:
    struct TilePicture {
        size_t tile = 0;
        Picture picture;    // of the left eye in stereo
        Picture right = {}; // empty: both eyes show `picture`
    };

    static Result<std::unique_ptr<WallWindows>> open(const WallWindowsConfig& config);
    WallWindows(const WallWindows&) = delete;
    WallWindows& operator=(const WallWindows&) = delete;
    ~WallWindows();

    // Returns when the server has the picture and no longer uses its memory. A window of another size is resized,
    // except in full screen.
    Result<void> show(size_t tile, const Picture& picture);

    // Draws all pictures, then shows them in quick succession.
    Result<void> showAll(std::span<const TilePicture> pictures);

    // Performs showAll() in two steps, for a swap barrier between them. present() shows the latest drawn pictures,
    // not before `atNs` (monotonicNowNs()). It returns when the server has them.
    Result<void> drawAll(std::span<const TilePicture> pictures);
    Result<int64_t> present(int64_t atNs);

    // True if the windows have a buffer per eye.
    [[nodiscard]] bool stereo() const;
    // Returns why requested stereo is not available; otherwise "".
    [[nodiscard]] std::string whyNotStereo() const;

    // Moves and resizes the same number of tiles. Pictures follow with the next show.
    Result<void> arrange(const std::vector<TileWindow>& tiles);

    // Returns whether the user has requested to close a window.
    [[nodiscard]] bool closeRequested() const;

    [[nodiscard]] std::string describe() const; // e.g. "4 windows on :0 (OpenGL, llvmpipe)"

private:
    struct Shared;
    explicit WallWindows(std::shared_ptr<Shared> shared);
    Result<void> take(std::span<const TilePicture> pictures, bool present);

    std::shared_ptr<Shared> shared_; // shared with the thread
    int64_t showTimeoutMs_;
};

} // namespace mural
