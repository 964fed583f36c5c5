// The private X display of --size: size, access, removal.
#include "nodes/launch/private_display.hpp"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <xcb/xcb.h>

namespace mural::launch {
namespace {

bool takes(const std::string& display, xcb_auth_info_t* key) {
    xcb_connection_t* connection = xcb_connect_to_display_with_auth_info(display.c_str(), key, nullptr);
    const bool taken = xcb_connection_has_error(connection) == 0;
    xcb_disconnect(connection);
    return taken;
}

TEST(XAuthority, writesOneEntryForEveryDisplay) {
    XAuthority::Cookie cookie{};
    cookie.back() = 0x7f;
    const std::string file = authorityFile(cookie);
    ASSERT_EQ(file.size(), 2u + 2 + 2 + 2 + 18 + 2 + 16);
    EXPECT_EQ(file.substr(0, 8), std::string("\xff\xff\0\0\0\0\0\x12", 8));
    EXPECT_EQ(file.substr(8, 18), "MIT-MAGIC-COOKIE-1");
    EXPECT_EQ(file.back(), '\x7f');
}

TEST(PrivateDisplay, hasTheRequestedSizeAndRequiresItsCookie) {
    auto display = PrivateDisplay::start(1234, 567);
    ASSERT_TRUE(display.ok()) << display.error().message;
    const PrivateDisplay& d = *display.value();

    std::string wrong(XAuthority::kCookieBytes, 'x');
    std::string protocol(kXAuthorityProtocol);
    xcb_auth_info_t key{static_cast<int>(protocol.size()), protocol.data(), static_cast<int>(wrong.size()),
                        wrong.data()};
    EXPECT_FALSE(takes(d.name(), &key));

    Environment environment({"WAYLAND_DISPLAY=wayland-0"});
    d.use(environment);
    EXPECT_EQ(environment.get("WAYLAND_DISPLAY"), std::nullopt);
    setenv("XAUTHORITY", environment.get("XAUTHORITY")->c_str(), 1); // as a program would find it
    xcb_connection_t* connection = xcb_connect(environment.get("DISPLAY")->c_str(), nullptr);
    ASSERT_EQ(xcb_connection_has_error(connection), 0);
    const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
    EXPECT_EQ(screen->width_in_pixels, 1234);
    EXPECT_EQ(screen->height_in_pixels, 567);
    EXPECT_EQ(screen->root_depth, 24);
    xcb_disconnect(connection);
    EXPECT_TRUE(displayUsable(d.name()));
}

// The server that listens on a display's socket; 0: none.
pid_t ownerOf(const std::string& socketPath) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    socketPath.copy(address.sun_path, sizeof address.sun_path - 1);
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ucred owner{};
    socklen_t size = sizeof owner;
    if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &owner, &size) != 0)
        owner.pid = 0;
    close(fd);
    return owner.pid;
}

TEST(PrivateDisplay, leavesNothingBehind) {
    auto display = PrivateDisplay::start(64, 64);
    ASSERT_TRUE(display.ok());
    const std::string name = display.value()->name();
    const std::string socket = "/tmp/.X11-unix/X" + name.substr(1);
    const pid_t pid = display.value()->pid();
    EXPECT_TRUE(std::filesystem::exists(socket));
    EXPECT_EQ(ownerOf(socket), pid);
    display.value().reset();
    EXPECT_FALSE(std::filesystem::exists("/proc/" + std::to_string(pid)));
    // Another server may have taken the number and the socket at once.
    const pid_t owner = ownerOf(socket);
    EXPECT_NE(owner, pid);
    EXPECT_TRUE(owner != 0 || !std::filesystem::exists(socket));
}

TEST(PrivateDisplay, quotesXvfbWhenItCannotStart) {
    auto display = PrivateDisplay::start(-5, 64);
    ASSERT_FALSE(display.ok());
    EXPECT_EQ(display.error().message.find('\n'), std::string::npos);
    EXPECT_NE(display.error().message.find("-5x64"), std::string::npos);
}

TEST(DisplayUsable, isFalseWithoutAName) { EXPECT_FALSE(displayUsable("")); }

} // namespace
} // namespace mural::launch
