// A program's view of the wall's size: its own connection, real requests, real events.
#include "nodes/launch/wall_window_manager.hpp"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <poll.h>

#include "common/base/clock.hpp"
#include "nodes/launch/private_display.hpp"

namespace mural::launch {
namespace {

constexpr int kWidth = 1501;
constexpr int kHeight = 907;

struct Geometry {
    int x, y, width, height;
    friend bool operator==(const Geometry&, const Geometry&) = default;
};
constexpr Geometry kWall{0, 0, kWidth, kHeight};

class WallWindows : public ::testing::Test {
protected:
    void SetUp() override {
        auto display = PrivateDisplay::start(kWidth, kHeight);
        ASSERT_TRUE(display.ok()) << display.error().message;
        display_ = std::move(display.value());
        auto manager = WallWindowManager::open(display_->name(), display_->authority().cookie(), kWidth, kHeight);
        ASSERT_TRUE(manager.ok()) << manager.error().message;
        manager_ = std::move(manager.value());
        setenv("XAUTHORITY", display_->authority().path().c_str(), 1);
        program_ = xcb_connect(display_->name().c_str(), nullptr);
        ASSERT_EQ(xcb_connection_has_error(program_), 0);
        screen_ = xcb_setup_roots_iterator(xcb_get_setup(program_)).data;
    }
    void TearDown() override {
        if (program_ != nullptr) xcb_disconnect(program_);
    }

    xcb_window_t create(int width, int height, bool overrideRedirect = false) {
        const xcb_window_t window = xcb_generate_id(program_);
        const uint32_t values[] = {overrideRedirect ? 1u : 0u, XCB_EVENT_MASK_STRUCTURE_NOTIFY};
        xcb_create_window(program_, screen_->root_depth, window, screen_->root, 20, 30, static_cast<uint16_t>(width),
                          static_cast<uint16_t>(height), 3, XCB_WINDOW_CLASS_INPUT_OUTPUT, screen_->root_visual,
                          XCB_CW_OVERRIDE_REDIRECT | XCB_CW_EVENT_MASK, values);
        return window;
    }
    void setAtoms(xcb_window_t window, const char* property, xcb_atom_t type, uint32_t value) {
        xcb_change_property(program_, XCB_PROP_MODE_REPLACE, window, atom(property), type, 32, 1, &value);
    }
    xcb_atom_t atom(const char* name) {
        xcb_intern_atom_reply_t* reply = xcb_intern_atom_reply(
            program_, xcb_intern_atom(program_, 0, static_cast<uint16_t>(std::strlen(name)), name), nullptr);
        const xcb_atom_t found = reply->atom;
        std::free(reply);
        return found;
    }
    Geometry geometry(xcb_window_t window) {
        xcb_get_geometry_reply_t* reply = xcb_get_geometry_reply(program_, xcb_get_geometry(program_, window), nullptr);
        const Geometry g{reply->x, reply->y, reply->width, reply->height};
        std::free(reply);
        return g;
    }
    // Runs the manager until an event of this kind reaches the program.
    bool await(uint8_t kind, const std::function<bool(const xcb_generic_event_t&)>& wanted) {
        xcb_flush(program_);
        const Deadline deadline = Deadline::inMs(10'000);
        while (!deadline.passed()) {
            pollfd waiting[2] = {{manager_->fd(), POLLIN, 0}, {xcb_get_file_descriptor(program_), POLLIN, 0}};
            poll(waiting, 2, 10);
            manager_->dispatch();
            while (xcb_generic_event_t* event = xcb_poll_for_event(program_)) {
                const bool found = (event->response_type & 0x7f) == kind && wanted(*event);
                std::free(event);
                if (found) return true;
            }
        }
        return false;
    }
    bool map(xcb_window_t window) {
        xcb_map_window(program_, window);
        return await(XCB_MAP_NOTIFY, [window](const xcb_generic_event_t& e) {
            return reinterpret_cast<const xcb_map_notify_event_t&>(e).window == window;
        });
    }

    std::unique_ptr<PrivateDisplay> display_;
    std::unique_ptr<WallWindowManager> manager_;
    xcb_connection_t* program_ = nullptr;
    const xcb_screen_t* screen_ = nullptr;
};

TEST_F(WallWindows, giveTheMainWindowTheWallsSizeBeforeItIsVisible) {
    const xcb_window_t window = create(300, 200);
    xcb_map_window(program_, window);
    bool sizedFirst = false;
    ASSERT_TRUE(await(XCB_CONFIGURE_NOTIFY, [&](const xcb_generic_event_t& e) {
        const auto& event = reinterpret_cast<const xcb_configure_notify_event_t&>(e);
        sizedFirst = event.window == window && event.width == kWidth && event.height == kHeight;
        return true;
    }));
    EXPECT_TRUE(sizedFirst);
    ASSERT_TRUE(await(XCB_MAP_NOTIFY, [](const auto&) { return true; }));
    EXPECT_EQ(geometry(window), kWall);
    EXPECT_EQ(manager_->mainWindow(), window);
}

TEST_F(WallWindows, answerLaterResizeRequestsWithTheWallsSize) {
    const xcb_window_t window = create(300, 200);
    ASSERT_TRUE(map(window));
    const uint32_t size[] = {640, 480};
    xcb_configure_window(program_, window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size);
    EXPECT_TRUE(await(XCB_CONFIGURE_NOTIFY, [](const xcb_generic_event_t& e) {
        const auto& event = reinterpret_cast<const xcb_configure_notify_event_t&>(e);
        return (event.response_type & 0x80) != 0 && event.width == kWidth && event.height == kHeight && event.x == 0;
    }));
    EXPECT_EQ(geometry(window), kWall);
}

TEST_F(WallWindows, keepTheSizeOfAuxiliaryWindows) {
    const xcb_window_t splash = create(320, 100);
    setAtoms(splash, "_NET_WM_WINDOW_TYPE", XCB_ATOM_ATOM, atom("_NET_WM_WINDOW_TYPE_SPLASH"));
    const xcb_window_t main = create(300, 200);
    const xcb_window_t dialog = create(150, 110);
    setAtoms(dialog, "WM_TRANSIENT_FOR", XCB_ATOM_WINDOW, main);
    const xcb_window_t menu = create(90, 60, true);
    const xcb_window_t second = create(400, 310);
    for (const xcb_window_t w : {splash, main, dialog, menu, second}) ASSERT_TRUE(map(w));
    EXPECT_EQ(geometry(main), kWall);
    EXPECT_EQ(geometry(splash), (Geometry{20, 30, 320, 100}));
    EXPECT_EQ(geometry(dialog), (Geometry{20, 30, 150, 110}));
    EXPECT_EQ(geometry(menu), (Geometry{20, 30, 90, 60}));
    EXPECT_EQ(geometry(second), (Geometry{20, 30, 400, 310}));
    const uint32_t size[] = {410, 320};
    xcb_configure_window(program_, second, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size);
    EXPECT_TRUE(await(XCB_CONFIGURE_NOTIFY, [&](const auto& e) {
        return reinterpret_cast<const xcb_configure_notify_event_t&>(e).window == second;
    }));
    EXPECT_EQ(geometry(second), (Geometry{20, 30, 410, 320}));
}

TEST_F(WallWindows, replaceAClosedMainWindow) {
    const xcb_window_t first = create(300, 200);
    const xcb_window_t second = create(400, 310);
    ASSERT_TRUE(map(first));
    ASSERT_TRUE(map(second));
    xcb_destroy_window(program_, first);
    EXPECT_TRUE(await(XCB_CONFIGURE_NOTIFY, [&](const xcb_generic_event_t& e) {
        const auto& event = reinterpret_cast<const xcb_configure_notify_event_t&>(e);
        return event.window == second && event.width == kWidth;
    }));
    EXPECT_EQ(geometry(second), kWall);
    EXPECT_EQ(manager_->mainWindow(), second);
}

TEST_F(WallWindows, allowOneManagerPerDisplay) {
    const auto another = WallWindowManager::open(display_->name(), display_->authority().cookie(), kWidth, kHeight);
    ASSERT_FALSE(another.ok());
    EXPECT_NE(another.error().message.find("window manager"), std::string::npos);
}

} // namespace
} // namespace mural::launch
