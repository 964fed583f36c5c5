// Wall windows on a private X server: position, size, contents.
#include "nodes/output/windows/wall_windows.hpp"
#include "nodes/input/display_input.hpp"
#include "nodes/overlay/overlay_picture.hpp"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <mutex>
#include <optional>
#include <poll.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "tests/output/test_pictures.hpp"
#include "tests/output/xvfb_server.hpp"

namespace mural::test {

namespace {

constexpr int kScreenWidth = 640;
constexpr int kScreenHeight = 480;

class Walls : public testing::Test {
protected:
    void SetUp() override { std::signal(SIGPIPE, SIG_IGN); } // as head and nodes do: servers end here

    void startServer(const std::vector<std::string>& options = {}) {
        auto server = XvfbServer::start(kScreenWidth, kScreenHeight, 24, options);
        ASSERT_TRUE(server) << server.error().message;
        server_ = std::move(server.value());
        auto client = XClient::open(server_->displayName());
        ASSERT_TRUE(client) << client.error().message;
        client_ = std::move(client.value());
    }

    WallWindowsConfig configFor(const std::vector<TileWindow>& tiles, WallDrawing drawing) {
        WallWindowsConfig config;
        config.displayName = server_->displayName();
        config.tiles = tiles;
        config.drawing = drawing;
        return config;
    }

    void openWall(const WallWindowsConfig& config) {
        auto wall = WallWindows::open(config);
        ASSERT_TRUE(wall) << wall.error().message;
        wall_ = std::move(wall.value());
    }

    void show(size_t tile, const Picture& picture) {
        Result<void> shown = wall_->show(tile, picture);
        ASSERT_TRUE(shown) << shown.error().message;
    }

    // x, y: upper left corner on the screen.
    void expectOnScreen(int x, int y, const Picture& expected) {
        auto seen = client_->seeScreen(x, y, expected.width, expected.height);
        ASSERT_TRUE(seen) << seen.error().message;
        EXPECT_TRUE(samePictures(expected, seen->view()));
    }

    // The only mapped child of the root with this size; 0: none.
    uint32_t findWindow(int width, int height) {
        xcb_connection_t* c = client_->get();
        XOwned<xcb_query_tree_reply_t> tree(xcb_query_tree_reply(c, xcb_query_tree(c, client_->root()), nullptr));
        for (int i = 0; tree && i < xcb_query_tree_children_length(tree.get()); ++i) {
            const xcb_window_t child = xcb_query_tree_children(tree.get())[i];
            XOwned<xcb_get_geometry_reply_t> geometry(xcb_get_geometry_reply(c, xcb_get_geometry(c, child), nullptr));
            if (geometry && geometry->width == width && geometry->height == height) return child;
        }
        return 0;
    }

    // For asynchronous actions of the windows' thread.
    template <class Condition> static bool becomesTrue(Condition condition) {
        const Deadline deadline = Deadline::inMs(20'000);
        while (!condition()) {
            if (deadline.passed()) return false;
            ::poll(nullptr, 0, 2);
        }
        return true;
    }

    std::unique_ptr<XvfbServer> server_;
    std::unique_ptr<XClient> client_;
    std::unique_ptr<WallWindows> wall_;
};

class DrawnWalls : public Walls, public testing::WithParamInterface<WallDrawing> {};

} // namespace

TEST(PlaceTiles, convertsTheOriginFromLowerLeftToUpperLeft) {
    const PixelViewport tiles[] = {{0, 0, 100, 40}, {100, 40, 60, 50}};
    const auto placed = placeTiles(tiles, 90);
    ASSERT_EQ(placed.size(), 2U);
    EXPECT_EQ(placed[0].screenX, 0);
    EXPECT_EQ(placed[0].screenY, 50);
    EXPECT_EQ(placed[1].screenX, 100);
    EXPECT_EQ(placed[1].screenY, 0);
}

// A picture in four tiles of odd sizes reappears on the screen.
TEST_P(DrawnWalls, showThePictureExactlyInTiles) {
    startServer();
    const PixelViewport tiles[] = {{0, 0, 201, 99}, {201, 0, 150, 99}, {0, 99, 201, 131}, {201, 99, 150, 131}};
    WallWindowsConfig config = configFor(placeTiles(tiles, 230), GetParam());
    config.positionX = 17;
    config.positionY = 33;
    openWall(config);
    for (uint32_t i = 0; i < 3; ++i) {
        const OwnedPicture whole = noisePicture(351, 230, i);
        std::vector<OwnedPicture> parts;
        std::vector<WallWindows::TilePicture> pictures;
        for (size_t t = 0; t < 4; ++t) parts.push_back(cutOut(whole.view(), tiles[t]));
        for (size_t t = 0; t < 4; ++t) pictures.push_back({t, parts[t].view()});
        if (i == 1) { // also one by one
            for (size_t t = 0; t < 4; ++t) show(t, parts[t].view());
        } else {
            Result<void> shown = wall_->showAll(pictures);
            ASSERT_TRUE(shown) << shown.error().message;
        }
        expectOnScreen(17, 33, whole.view());
    }
    EXPECT_FALSE(wall_->closeRequested());
    EXPECT_NE(wall_->describe().find("4 windows on " + server_->displayName()), std::string::npos);
}

TEST_P(DrawnWalls, resizeWindowsToThePicture) {
    startServer();
    openWall(configFor({{{0, 0, 100, 100}, 50, 60, "wall", -1}}, GetParam()));
    for (const auto& size : {std::pair{100, 100}, std::pair{203, 157}, std::pair{31, 300}, std::pair{100, 100}}) {
        const OwnedPicture picture = noisePicture(size.first, size.second, static_cast<uint32_t>(size.first));
        show(0, picture.view());
        expectOnScreen(50, 60, picture.view());
        // Nothing of an earlier larger window remains beside it.
        expectOnScreen(50 + size.first, 60, plainPicture(5, 5, 0, 0, 0).view());
        EXPECT_NE(findWindow(size.first, size.second), 0U);
    }
}

TEST_P(DrawnWalls, moveAndResizeWhenArranged) {
    startServer();
    openWall(configFor({{{0, 0, 100, 100}, 0, 0, "wall", -1}}, GetParam()));
    const OwnedPicture first = noisePicture(100, 100, 1);
    show(0, first.view());
    Result<void> arranged = wall_->arrange({{{0, 0, 80, 40}, 200, 300, "wall", -1}});
    ASSERT_TRUE(arranged) << arranged.error().message;
    const OwnedPicture second = noisePicture(80, 40, 2);
    show(0, second.view());
    expectOnScreen(200, 300, second.view());
    expectOnScreen(0, 0, plainPicture(100, 100, 0, 0, 0).view());
    EXPECT_FALSE(wall_->arrange({}));
}

TEST_P(DrawnWalls, drawTheOverlayOverKeptPictures) {
    startServer();
    const auto overlay = std::make_shared<Overlay>("host", "node 0");
    WallWindowsConfig config = configFor({{{90, 70, 220, 150}, 20, 30, "wall", -1}}, GetParam());
    config.overlay = overlay;
    config.wall.wallWidth = 400;
    config.wall.wallHeight = 300;
    openWall(config);
    const auto shows = [&](const Picture& expected) {
        return becomesTrue([&] {
            auto seen = client_->seeScreen(20, 30, expected.width, expected.height);
            return seen && comparePictures(expected, seen->view()).same();
        });
    };
    OverlayPlace place = config.wall;
    place.title = "wall";
    place.part = {90, 70, 220, 150};
    const auto withOverlay = [&](const OwnedPicture& picture) {
        OwnedPicture both(picture.view());
        drawOverlay(overlay->content(), place).drawOver(both.data(), PictureFormat::Bgra8);
        return both;
    };
    const OwnedPicture first = noisePicture(220, 150, 1), second = noisePicture(220, 150, 2);
    show(0, first.view());
    EXPECT_TRUE(shows(first.view()));
    for (const OverlayMode mode : {OverlayMode::Grid, OverlayMode::Names}) {
        overlay->setMode(mode);
        EXPECT_TRUE(shows(withOverlay(first).view())) << nameOf(mode);
        overlay->setMode(OverlayMode::Off);
        EXPECT_TRUE(shows(first.view())) << nameOf(mode);
    }
    // A picture that waits for a swap barrier is not shown early.
    const WallWindows::TilePicture waiting[] = {{0, second.view()}};
    ASSERT_TRUE(wall_->drawAll(waiting));
    overlay->setMode(OverlayMode::Grid);
    ::poll(nullptr, 0, static_cast<int>(2 * kOverlayMs));
    EXPECT_TRUE(shows(first.view()));
    ASSERT_TRUE(wall_->present(0));
    EXPECT_TRUE(shows(withOverlay(second).view()));
}

TEST_P(DrawnWalls, fillTheMonitorWithoutScalingInFullScreen) {
    startServer();
    WallWindowsConfig config = configFor({{{0, 0, 200, 100}, 5, 5, "wall", -1}}, GetParam());
    config.fullScreen = true;
    openWall(config);
    EXPECT_NE(findWindow(kScreenWidth, kScreenHeight), 0U);
    const OwnedPicture full = noisePicture(kScreenWidth, kScreenHeight, 1);
    show(0, full.view());
    expectOnScreen(0, 0, full.view());
    // A smaller picture is not scaled, with black around it.
    const OwnedPicture small = noisePicture(200, 100, 2);
    show(0, small.view());
    OwnedPicture expected = plainPicture(kScreenWidth, kScreenHeight, 0, 0, 0);
    copyInto(expected, 0, kScreenHeight - 100, small.view());
    expectOnScreen(0, 0, expected.view());
    // A larger one is clipped.
    const OwnedPicture large = noisePicture(kScreenWidth + 10, kScreenHeight + 20, 3);
    show(0, large.view());
    expectOnScreen(0, 0, cutOut(large.view(), {0, 20, kScreenWidth, kScreenHeight}).view());
}

TEST_P(DrawnWalls, redrawWhenUncovered) {
    startServer();
    openWall(configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, GetParam()));
    const OwnedPicture picture = noisePicture(120, 90, 1);
    show(0, picture.view());
    const uint32_t cover = client_->makeWindow(0, 0, 80, 80, 0xff0000);
    client_->destroyWindow(cover);
    EXPECT_TRUE(becomesTrue([&] {
        auto seen = client_->seeScreen(10, 10, 120, 90);
        return seen && comparePictures(picture.view(), seen->view()).same();
    }));
}

TEST_P(DrawnWalls, detectTheCloseButton) {
    startServer();
    openWall(configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, GetParam()));
    EXPECT_FALSE(wall_->closeRequested());
    xcb_connection_t* c = client_->get();
    const auto atom = [&](const char* name) {
        XOwned<xcb_intern_atom_reply_t> reply(
            xcb_intern_atom_reply(c, xcb_intern_atom(c, 0, static_cast<uint16_t>(std::strlen(name)), name), nullptr));
        return reply->atom;
    };
    xcb_client_message_event_t message{};
    message.response_type = XCB_CLIENT_MESSAGE;
    message.format = 32;
    message.window = findWindow(120, 90);
    ASSERT_NE(message.window, 0U);
    message.type = atom("WM_PROTOCOLS");
    message.data.data32[0] = atom("WM_DELETE_WINDOW");
    xcb_send_event(c, 0, message.window, 0, reinterpret_cast<const char*>(&message));
    client_->sync();
    EXPECT_TRUE(becomesTrue([&] { return wall_->closeRequested(); }));
    // The wall continues until its owner ends it.
    const OwnedPicture picture = noisePicture(120, 90, 1);
    show(0, picture.view());
    expectOnScreen(10, 10, picture.view());
}

TEST_P(DrawnWalls, surviveAWindowDestroyedByOthers) {
    startServer();
    openWall(configFor({{{0, 0, 120, 90}, 0, 0, "a", -1}, {{0, 0, 64, 64}, 200, 0, "b", -1}}, GetParam()));
    const OwnedPicture a = noisePicture(120, 90, 1);
    const OwnedPicture b = noisePicture(64, 64, 1);
    show(0, a.view());
    client_->destroyWindow(findWindow(120, 90));
    (void)wall_->show(0, a.view()); // any result is valid; the other window lives
    (void)wall_->show(0, b.view());
    show(1, b.view());
    expectOnScreen(200, 0, b.view());
}

TEST_P(DrawnWalls, stopAtTheDeadlineWithAStoppedServer) {
    startServer();
    WallWindowsConfig config = configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, GetParam());
    config.showTimeoutMs = 200;
    openWall(config);
    const OwnedPicture picture = noisePicture(120, 90, 1);
    ASSERT_EQ(::kill(server_->pid(), SIGSTOP), 0);
    for (int i = 0; i < 2; ++i) {
        Result<void> shown = wall_->show(0, picture.view());
        ASSERT_FALSE(shown);
        EXPECT_NE(shown.error().message.find("in time"), std::string::npos) << shown.error().message;
    }
    ASSERT_EQ(::kill(server_->pid(), SIGCONT), 0);
    EXPECT_TRUE(becomesTrue([&] { return wall_->show(0, picture.view()).ok(); }));
    expectOnScreen(10, 10, picture.view());
}

TEST_P(DrawnWalls, stopOpeningAtTheDeadlineWithAStoppedServer) {
    startServer();
    WallWindowsConfig config = configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, GetParam());
    config.openTimeoutMs = 100;
    config.showTimeoutMs = 100;
    ASSERT_EQ(::kill(server_->pid(), SIGSTOP), 0);
    auto late = WallWindows::open(config);
    ASSERT_FALSE(late);
    EXPECT_NE(late.error().message.find("in time"), std::string::npos) << late.error().message;
    ASSERT_EQ(::kill(server_->pid(), SIGCONT), 0);
    // Works again once the abandoned thread has ended.
    config.openTimeoutMs = 20'000;
    config.showTimeoutMs = 20'000;
    EXPECT_TRUE(becomesTrue([&] {
        auto wall = WallWindows::open(config);
        if (wall) wall_ = std::move(wall.value());
        return wall_ != nullptr;
    }));
    ASSERT_NE(wall_, nullptr);
    const OwnedPicture picture = noisePicture(120, 90, 1);
    show(0, picture.view());
    expectOnScreen(10, 10, picture.view());
}

TEST_P(DrawnWalls, reportAServerThatEnds) {
    startServer();
    openWall(configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, GetParam()));
    const OwnedPicture picture = noisePicture(120, 90, 1);
    show(0, picture.view());
    server_->kill();
    for (int i = 0; i < 2; ++i) {
        Result<void> shown = wall_->show(0, picture.view());
        ASSERT_FALSE(shown);
        EXPECT_NE(shown.error().message.find("is lost"), std::string::npos) << shown.error().message;
    }
    wall_.reset();
    // Another display works afterwards.
    startServer();
    openWall(configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, GetParam()));
    show(0, picture.view());
    expectOnScreen(10, 10, picture.view());
}

INSTANTIATE_TEST_SUITE_P(Ways, DrawnWalls, testing::Values(WallDrawing::OpenGl, WallDrawing::XPut),
                         [](const auto& way) { return way.param == WallDrawing::OpenGl ? "OpenGl" : "XPut"; });

TEST_F(Walls, letTheServerDrawWithoutGlx) {
    startServer({"-extension", "GLX"});
    const std::vector<TileWindow> tiles = {{{0, 0, 120, 90}, 10, 10, "wall", -1}};
    auto openGl = WallWindows::open(configFor(tiles, WallDrawing::OpenGl));
    ASSERT_FALSE(openGl);
    EXPECT_NE(openGl.error().message.find("GLX"), std::string::npos) << openGl.error().message;
    openWall(configFor(tiles, WallDrawing::Auto));
    const OwnedPicture picture = noisePicture(120, 90, 1);
    show(0, picture.view());
    expectOnScreen(10, 10, picture.view());
}

TEST_F(Walls, areExactWithAuto) {
    startServer();
    openWall(configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}, {{0, 0, 64, 64}, 200, 0, "b", -1}}, WallDrawing::Auto));
    const OwnedPicture a = noisePicture(120, 90, 1);
    const OwnedPicture b = noisePicture(64, 64, 2);
    show(0, a.view());
    show(1, b.view());
    expectOnScreen(10, 10, a.view());
    expectOnScreen(200, 0, b.view());
}

// The upper left tile of a wall of 240x180 pixels.
TEST_F(Walls, reportInputWithItsPlaceOnTheWall) {
    startServer();
    std::mutex mutex; // guards events
    std::vector<input::InputEvent> events;
    WallWindowsConfig config = configFor({{{0, 90, 120, 90}, 30, 40, "wall", -1}}, WallDrawing::XPut);
    config.wall.wallWidth = 240;
    config.wall.wallHeight = 180;
    config.hasBorders = true;
    config.onInput = [&](const input::InputEvent& event) {
        const std::lock_guard lock(mutex);
        events.push_back(event);
    };
    openWall(config);
    show(0, noisePicture(120, 90, 1).view());
    const auto find = [&](auto isWanted) -> std::optional<input::InputEvent> {
        const std::lock_guard lock(mutex);
        const auto found = std::ranges::find_if(events, isWanted);
        return found == events.end() ? std::nullopt : std::optional(*found);
    };
    auto hand = input::DisplayInput::open({server_->displayName(), "", false, findWindow(120, 90)});
    ASSERT_TRUE(hand) << hand.error().message;
    input::InputEvent click;
    click.kind = input::InputKind::Down;
    click.hasPlace = true;
    click.x = 0.25, click.y = 0.5; // of the window
    click.button = 3;
    (*hand)->send(click);
    const auto isDown = [](const auto& event) { return event.kind == input::InputKind::Down; };
    ASSERT_TRUE(becomesTrue([&] { return find(isDown).has_value(); }));
    EXPECT_EQ(find(isDown)->button, 3);
    EXPECT_NEAR(find(isDown)->x, 30.5 / 240, 1e-9);
    EXPECT_NEAR(find(isDown)->y, 45.5 / 180, 1e-9);
    input::InputEvent wheel;
    wheel.kind = input::InputKind::Wheel;
    wheel.wheelY = 120;
    (*hand)->send(wheel);
    const auto isWheel = [](const auto& event) { return event.kind == input::InputKind::Wheel; };
    ASSERT_TRUE(becomesTrue([&] { return find(isWheel).has_value(); }));
    EXPECT_EQ(find(isWheel)->wheelY, 120);
    input::InputEvent key;
    key.kind = input::InputKind::Key;
    key.key = "A", key.code = "KeyA"; // needs Shift
    key.isDown = true;
    (*hand)->send(key);
    const auto isKey = [](const auto& event) { return event.keysym == 'A' && event.isDown; };
    EXPECT_TRUE(becomesTrue([&] { return find(isKey).has_value(); }));
    client_->resizeWindow(findWindow(120, 90), 160, 100);
    const auto isSize = [](const auto& event) { return event.kind == input::InputKind::Size && event.width == 160; };
    EXPECT_TRUE(becomesTrue([&] { return find(isSize).has_value(); }));
    (*hand)->send({.kind = input::InputKind::Close});
    EXPECT_TRUE(becomesTrue([&] { return wall_->closeRequested(); }));
    wall_.reset(); // its thread uses the mutex
}

TEST_F(Walls, reportMissingParts) {
    startServer();
    const std::vector<TileWindow> tiles = {{{0, 0, 120, 90}, 10, 10, "a", -1}, {{0, 0, 120, 90}, 200, 10, "b", -1}};
    WallWindowsConfig config = configFor(tiles, WallDrawing::Auto);
    config.displayName = ":64999";
    auto noDisplay = WallWindows::open(config);
    ASSERT_FALSE(noDisplay);
    EXPECT_NE(noDisplay.error().message.find("':64999'"), std::string::npos) << noDisplay.error().message;
    config = configFor(tiles, WallDrawing::Auto);
    config.fullScreen = true;
    auto noMonitor = WallWindows::open(config);
    ASSERT_FALSE(noMonitor);
    EXPECT_NE(noMonitor.error().message.find("no monitor 2"), std::string::npos) << noMonitor.error().message;
    EXPECT_FALSE(WallWindows::open(configFor({}, WallDrawing::Auto)));
    openWall(configFor(tiles, WallDrawing::XPut));
    auto second = WallWindows::open(configFor(tiles, WallDrawing::XPut));
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("open in this process already"), std::string::npos);
    EXPECT_FALSE(wall_->show(2, noisePicture(4, 4, 1).view()));
    EXPECT_FALSE(wall_->show(0, Picture{}));
}

TEST_F(Walls, preserveTheEnvironment) {
    startServer();
    ::setenv("DISPLAY", ":64998", 1);
    openWall(configFor({{{0, 0, 64, 64}, 0, 0, "a", -1}}, WallDrawing::Auto));
    EXPECT_STREQ(::getenv("DISPLAY"), ":64998");
}

// A render node has an EGL context current while it shows its tiles.
TEST_F(Walls, preserveTheCallersCurrentContext) {
    startServer();
    const auto getDisplay =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    ASSERT_NE(getDisplay, nullptr);
    EGLDisplay display = getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    ASSERT_TRUE(eglInitialize(display, nullptr, nullptr));
    eglBindAPI(EGL_OPENGL_API);
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    ASSERT_NE(context, EGL_NO_CONTEXT);
    ASSERT_TRUE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
    openWall(configFor({{{0, 0, 120, 90}, 10, 10, "wall", -1}}, WallDrawing::OpenGl));
    const OwnedPicture picture = noisePicture(120, 90, 1);
    show(0, picture.view());
    expectOnScreen(10, 10, picture.view());
    EXPECT_EQ(eglGetCurrentContext(), context);
    const auto getString = reinterpret_cast<const unsigned char* (*)(unsigned)>(eglGetProcAddress("glGetString"));
    EXPECT_NE(getString(0x1F01 /* GL_RENDERER */), nullptr);
    wall_.reset();
    EXPECT_EQ(eglGetCurrentContext(), context);
    EXPECT_NE(getString(0x1F01), nullptr);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    eglTerminate(display);
}

} // namespace mural::test
