// One window of the wall (class WallWindow of wall_screen.hpp): its creation, its size, and how pictures are drawn.
#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "common/base/clock.hpp"
#include "nodes/gl/software_renderer.hpp"
#include "nodes/output/windows/wall_screen.hpp"

#include "nodes/output/windows/glfw_x11.hpp" // last: Xlib's macros

namespace mural {

namespace {

// A window manager grants a size request within this time or not at all.
constexpr int64_t kResizeMs = 250;

struct Monitor {
    GLFWmonitor* monitor;
    int x, y;
};

// In reading order. GLFW lists the primary monitor first.
std::vector<Monitor> monitorsInOrder() {
    int count = 0;
    GLFWmonitor** all = glfwGetMonitors(&count);
    std::vector<Monitor> monitors;
    for (int i = 0; i < count; ++i) {
        Monitor m{all[i], 0, 0};
        glfwGetMonitorPos(m.monitor, &m.x, &m.y);
        monitors.push_back(m);
    }
    std::stable_sort(monitors.begin(), monitors.end(),
                     [](const Monitor& a, const Monitor& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); });
    return monitors;
}

void setHints(const WallWindow::Options& options) {
    glfwDefaultWindowHints();
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "mural");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "wall");
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DECORATED, GLFW_FALSE);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    // The program keeps the keyboard and pointer focus, and full-screen windows stay when another window is used.
    glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
    if (options.hasBorders)
        for (const int hint : {GLFW_DECORATED, GLFW_RESIZABLE, GLFW_FOCUSED, GLFW_FOCUS_ON_SHOW})
            glfwWindowHint(hint, GLFW_TRUE);
    glfwWindowHint(GLFW_CENTER_CURSOR, GLFW_FALSE);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
    if (!options.openGl) {
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        return;
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    glfwWindowHint(GLFW_ALPHA_BITS, 0); // an alpha channel would let the desktop show through
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_STEREO, options.stereo ? GLFW_TRUE : GLFW_FALSE);
}

} // namespace

bool WallWindow::openGlIsFast(const GlfwSession& session) {
    setHints({});
    GLFWwindow* hidden = glfwCreateWindow(16, 16, "Mural", nullptr, nullptr);
    session.guardErrors();
    if (hidden == nullptr) {
        (void)GlfwSession::takeError();
        return false;
    }
    glfwMakeContextCurrent(hidden);
    bool fast = false;
    if (auto blit = TextureBlit::create(glfwGetProcAddress); blit)
        fast = !gl::drawsWithoutGpu(blit.value()->renderer());
    glfwDestroyWindow(hidden);
    return fast;
}

Result<std::unique_ptr<WallWindow>> WallWindow::open(GlfwSession& session, const Options& options) {
    std::unique_ptr<WallWindow> window(new WallWindow(session, options.overlay));
    window->onWall_ = options.onWall;
    window->fullScreen_ = options.fullScreen;
    window->title_ = options.title;
    window->stereo_ = options.stereo;
    setHints(options);
    Result<void> created = options.fullScreen ? window->createFullScreen(options) : window->create(options);
    session.guardErrors();
    if (!created) return created.error();
    // The background that the server paints before the first picture.
    Display* display = glfwGetX11Display();
    XSetWindowBackground(display, glfwGetX11Window(window->window_), BlackPixel(display, DefaultScreen(display)));
    glfwSetWindowUserPointer(window->window_, window.get());
    glfwSetWindowRefreshCallback(window->window_, [](GLFWwindow* uncovered) {
        static_cast<WallWindow*>(glfwGetWindowUserPointer(uncovered))->uncovered_ = true;
    });
    if (options.onInput) {
        window->input_ = std::make_unique<WindowInput>(options.onInput, window->onWall_);
        attachInput(window->window_, options.hasBorders && !options.fullScreen);
    }
    if (options.fullScreen)
        glfwSetInputMode(window->window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
    else
        glfwShowWindow(window->window_);
    if (!session.sync()) return Error{fmt::format("{}: the display is lost", window->where())};
    if (Result<void> prepared = window->prepareDrawing(options); !prepared) return prepared.error();
    return window;
}

WallWindow::~WallWindow() {
    if (window_ == nullptr) return;
    if (blit_) glfwMakeContextCurrent(window_);
    blit_.reset();
    painter_.reset();
    session_.guardErrors();
    glfwDestroyWindow(window_);
}

Result<void> WallWindow::create(const Options& options) {
    wantedWidth_ = std::max(options.place.w, 1);
    wantedHeight_ = std::max(options.place.h, 1);
    window_ = glfwCreateWindow(wantedWidth_, wantedHeight_, title_.c_str(), nullptr, nullptr);
    if (window_ == nullptr) return Error{fmt::format("cannot open {}: {}", where(), GlfwSession::takeError())};
    glfwSetWindowPos(window_, options.place.x, options.place.y);
    return {};
}

Result<void> WallWindow::createFullScreen(const Options& options) {
    const std::vector<Monitor> monitors = monitorsInOrder();
    if (options.monitor < 0 || static_cast<size_t>(options.monitor) >= monitors.size()) {
        return Error{fmt::format("no monitor {} for {}: the X display '{}' has {}; use fewer tiles "
                                 "per machine, or windows instead of the full screen",
                                 options.monitor + 1, where(), session_.displayName(), monitors.size())};
    }
    GLFWmonitor* monitor = monitors[static_cast<size_t>(options.monitor)].monitor;
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    if (mode == nullptr) return Error{fmt::format("cannot open {}: {}", where(), GlfwSession::takeError())};
    glfwWindowHint(GLFW_REFRESH_RATE, mode->refreshRate); // the current rate: no mode change
    window_ = glfwCreateWindow(mode->width, mode->height, title_.c_str(), monitor, nullptr);
    if (window_ == nullptr) return Error{fmt::format("cannot open {}: {}", where(), GlfwSession::takeError())};
    return {};
}

Result<void> WallWindow::prepareDrawing(const Options& options) {
    if (options.openGl) {
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(options.waitForRefresh ? 1 : 0);
        auto blit = TextureBlit::create(glfwGetProcAddress);
        if (!blit) return blit.error();
        blit_ = std::move(blit.value());
        if (stereo_ && !blit_->stereo())
            return Error{fmt::format("{}: {} has no buffer for each eye", where(), blit_->renderer())};
    } else {
        AppWindowConfig config;
        config.displayName = session_.displayName();
        config.window = static_cast<uint32_t>(glfwGetX11Window(window_));
        config.timeoutMs = options.timeoutMs;
        auto painter = AppWindow::open(config);
        if (!painter) return painter.error();
        painter_ = std::move(painter.value());
        XClearWindow(glfwGetX11Display(), glfwGetX11Window(window_));
        return {};
    }
    if (Result<void> drawn = drawShown(); !drawn) return drawn;
    return present();
}

Result<void> WallWindow::move(const PixelViewport& place, OverlayPlace onWall) {
    onWall_ = std::move(onWall);
    if (input_) input_->place(onWall_);
    if (fullScreen_) return {};
    glfwSetWindowPos(window_, place.x, place.y);
    resize(std::max(place.w, 1), std::max(place.h, 1));
    return {};
}

void WallWindow::resize(int width, int height) {
    if (fullScreen_ || (width == wantedWidth_ && height == wantedHeight_)) return;
    wantedWidth_ = width;
    wantedHeight_ = height;
    if (input_) input_->expectSize(width, height);
    glfwSetWindowSize(window_, width, height);
    const Deadline deadline = Deadline::inMs(kResizeMs);
    while (session_.sync()) {
        glfwPollEvents();
        int realWidth = 0;
        int realHeight = 0;
        glfwGetFramebufferSize(window_, &realWidth, &realHeight);
        if ((realWidth == width && realHeight == height) || deadline.passed()) return;
        session_.waitForEvents(-1, deadline.leftNs());
    }
}

Result<void> WallWindow::draw(OwnedPicture& picture, OwnedPicture& right) {
    const bool otherSize = picture.width() != shown_.width() || picture.height() != shown_.height();
    resize(picture.width(), picture.height());
    std::swap(shown_, picture);
    std::swap(shownRight_, right);
    if (blit_) {
        glfwMakeContextCurrent(window_);
    } else if (otherSize) {
        // Clears remains of the previous picture beside the new one, in order with the requests of the connection that
        // paints.
        XClearWindow(glfwGetX11Display(), glfwGetX11Window(window_));
        (void)session_.sync();
    }
    return drawShown();
}

Result<void> WallWindow::drawShown() {
    uncovered_ = false;
    if (!blit_) {
        painted_ = overlay_.over(shown_.view(), onWall_);
        return {};
    }
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (!stereo_) return drawEye(shown_.view(), TextureBlit::Target::Back, width, height);
    Result<void> left = drawEye(shown_.view(), TextureBlit::Target::BackLeft, width, height);
    if (!left) return left;
    const Picture right = shownRight_.view().empty() ? shown_.view() : shownRight_.view();
    return drawEye(right, TextureBlit::Target::BackRight, width, height);
}

// Without a picture, draws black.
Result<void> WallWindow::drawEye(const Picture& picture, TextureBlit::Target target, int width, int height) {
    if (!picture.empty())
        if (Result<void> uploaded = blit_->upload(overlay_.over(picture, onWall_)); !uploaded) return uploaded;
    return blit_->draw(target, width, height);
}

Result<void> WallWindow::present() {
    if (blit_) {
        glfwMakeContextCurrent(window_);
        glfwSwapBuffers(window_);
        return {};
    }
    if (painted_.empty()) return {};
    return painter_->show(0, painted_);
}

void WallWindow::finish() {
    if (!blit_) return;
    glfwMakeContextCurrent(window_);
    blit_->finish();
}

Result<void> WallWindow::redrawIfNeeded() {
    if (!uncovered_ && (shown_.view().empty() || !overlay_.isOutdated())) return {};
    if (blit_) glfwMakeContextCurrent(window_);
    if (Result<void> drawn = drawShown(); !drawn) return drawn;
    return present();
}

bool WallWindow::closeRequested() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

std::string WallWindow::drawnBy() const {
    return blit_ ? fmt::format("OpenGL, {}", blit_->renderer()) : "drawn by the X server";
}

std::string WallWindow::where() const {
    return fmt::format("the wall window '{}' on the X display '{}'", title_, session_.displayName());
}

} // namespace mural
