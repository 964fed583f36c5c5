// An X server of the test's own, and eyes to see what is on it.
#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

#include "common/result.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/output/x_connection.hpp"

namespace mural::test {

class XvfbServer {
public:
    // Takes the first free display number. `options`: more arguments for Xvfb.
    static Result<std::unique_ptr<XvfbServer>>
    start(int width, int height, int depth, const std::vector<std::string>& options = {});
    XvfbServer(const XvfbServer&) = delete;
    XvfbServer& operator=(const XvfbServer&) = delete;
    ~XvfbServer() { kill(); }

    [[nodiscard]] const std::string& displayName() const { return displayName_; }
    [[nodiscard]] pid_t pid() const { return pid_; }
    void kill();

private:
    XvfbServer() = default;
    pid_t pid_ = -1;
    std::string displayName_;
};

// Another X client: its windows play the program's own ones, its eyes see the screen.
class XClient {
public:
    static Result<std::unique_ptr<XClient>> open(const std::string& displayName);

    // A mapped window in the upper left corner, filled with `pixel`. depth 0: as the screen.
    uint32_t makeWindow(
        int x, int y, int width, int height, uint32_t pixel, int depth = 0, uint32_t parent = 0);
    void destroyWindow(uint32_t window);
    void unmapWindow(uint32_t window);
    void resizeWindow(uint32_t window, int width, int height);
    void sync();

    // What a part of the window shows, children and windows above included. Channels of less or
    // more than 8 bits are left as they are stored (so at most 8 bits of them are seen).
    Result<OwnedPicture> see(uint32_t window, int x, int y, int width, int height);
    Result<OwnedPicture> seeScreen(int x, int y, int width, int height) {
        return see(root(), x, y, width, height);
    }
    // The stored pixel itself.
    Result<uint32_t> pixelAt(uint32_t window, int x, int y);

    [[nodiscard]] uint32_t root() const { return screen().root; }
    [[nodiscard]] const xcb_screen_t& screen() const;
    xcb_connection_t* get() { return x_->get(); }

private:
    explicit XClient(std::unique_ptr<XConnection> x)
        : x_(std::move(x)) {}
    Result<XOwned<xcb_get_image_reply_t>>
    image(uint32_t window, int x, int y, int width, int height);
    std::unique_ptr<XConnection> x_;
};

} // namespace mural::test
