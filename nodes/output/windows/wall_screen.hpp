// The windows of WallWindows. All objects belong to the thread that opened them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/output/windows/app_window.hpp"
#include "nodes/output/windows/glfw_session.hpp"
#include "nodes/output/windows/overlay_layer.hpp"
#include "nodes/output/windows/texture_blit.hpp"
#include "nodes/output/windows/wall_windows.hpp"
#include "nodes/output/windows/window_input.hpp"

struct GLFWwindow;

namespace mural {

// One window of the wall.
class WallWindow {
public:
    struct Options {
        PixelViewport place; // x, y: upper left corner on the screen, y down; w, h: size
        std::string title;
        bool fullScreen = false;
        int monitor = 0;
        bool openGl = true;
        bool stereo = false; // with openGl
        bool waitForRefresh = false;
        int64_t timeoutMs = 0;
        std::shared_ptr<const Overlay> overlay; // null: none
        OverlayPlace onWall;                    // for the overlay and the input
        WindowInput::OnInput onInput;           // empty: none
        bool hasBorders = false;
    };

    static Result<std::unique_ptr<WallWindow>> open(GlfwSession& session, const Options& options);

    // Returns whether the display has OpenGL 3.0 on a graphics card. Opens no visible window.
    static bool openGlIsFast(const GlfwSession& session);

    WallWindow(const WallWindow&) = delete;
    WallWindow& operator=(const WallWindow&) = delete;
    ~WallWindow();

    // onWall: for the overlay and the input.
    Result<void> move(const PixelViewport& place, OverlayPlace onWall);

    // Swaps the picture with the previous one, whose memory can be reused. right: for windows with a buffer per eye;
    // empty: both eyes show `picture`.
    Result<void> draw(OwnedPicture& picture, OwnedPicture& right);
    Result<void> present(); // makes the drawn picture visible
    void finish();          // returns when the picture is on its way to the screen

    // Shows the latest picture again if the window was uncovered or the overlay has changed.
    Result<void> redrawIfNeeded();
    [[nodiscard]] bool closeRequested() const;
    [[nodiscard]] std::string drawnBy() const;
    // For the callbacks of GLFW. Null: the window takes no input.
    [[nodiscard]] WindowInput* input() { return input_.get(); }

private:
    WallWindow(GlfwSession& session, std::shared_ptr<const Overlay> overlay)
        : session_(session), overlay_(std::move(overlay)) {}

    Result<void> create(const Options& options);
    Result<void> createFullScreen(const Options& options);
    Result<void> prepareDrawing(const Options& options);
    void resize(int width, int height);
    Result<void> drawShown();
    Result<void> drawEye(const Picture& picture, TextureBlit::Target target, int width, int height);
    [[nodiscard]] std::string where() const;

    GlfwSession& session_;
    GLFWwindow* window_ = nullptr;
    bool fullScreen_ = false;
    int wantedWidth_ = 0; // last requested size; a window manager may refuse it
    int wantedHeight_ = 0;
    std::string title_;
    OverlayLayer overlay_;
    OverlayPlace onWall_;
    OwnedPicture shown_;      // the shown picture, without overlay
    OwnedPicture shownRight_; // empty: both eyes show shown_
    Picture painted_;         // for painter_: shown_ with the overlay
    bool stereo_ = false;
    std::unique_ptr<TextureBlit> blit_; // one of the two is set
    std::unique_ptr<AppWindow> painter_;
    std::unique_ptr<WindowInput> input_; // null: none
    bool uncovered_ = false;
};

class WallScreen {
public:
    static Result<std::unique_ptr<WallScreen>> open(const WallWindowsConfig& config);

    struct TileBuffer {
        size_t tile = 0;
        OwnedPicture picture;
        OwnedPicture right; // empty: none
    };
    // Draws the pictures, and leaves reusable memory in the buffers.
    Result<void> draw(std::vector<TileBuffer>& buffers);
    // Shows the drawn pictures in quick succession, not before `atNs` (monotonicNowNs()).
    Result<void> present(int64_t atNs = 0);
    // Returns the time at which the server had the last pictures (monotonicNowNs()).
    [[nodiscard]] int64_t presentedNs() const { return presentedNs_; }
    Result<void> arrange(const std::vector<TileWindow>& tiles);

    // Processes events from the server.
    Result<void> doWork();
    void waitForEvents(int wakeFd, int64_t timeoutNs) { session_->waitForEvents(wakeFd, timeoutNs); }
    [[nodiscard]] bool closeRequested() const;
    [[nodiscard]] std::string describe() const;
    [[nodiscard]] bool stereo() const { return stereo_; }
    [[nodiscard]] const std::string& whyNotStereo() const { return whyNotStereo_; }

private:
    explicit WallScreen(WallWindowsConfig config) : config_(std::move(config)) {}

    Result<void> openWindows(bool openGl, bool stereo);
    [[nodiscard]] PixelViewport placeOf(const TileWindow& tile) const;
    [[nodiscard]] OverlayPlace onWall(const TileWindow& tile) const;
    Result<void> checkDisplay() const;

    WallWindowsConfig config_;
    std::unique_ptr<GlfwSession> session_; // declared before the windows, which it outlives
    std::vector<std::unique_ptr<WallWindow>> windows_;
    std::vector<size_t> drawn_; // tiles with a picture that is not shown yet
    int64_t presentedNs_ = 0;
    bool stereo_ = false;
    std::string whyNotStereo_;
};

} // namespace mural
