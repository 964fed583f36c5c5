// An X server of the test, and a client that reads its screen.
#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/output/windows/x_connection.hpp"

namespace mural::test {

class XvfbServer {
public:
    // Uses the first free display number. `options`: additional arguments for Xvfb.
    static Result<std::unique_ptr<XvfbServer>> start(int width, int height, int depth,
                                                     const std::vector<std::string>& options = {});
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

// Another X client: its windows stand for the program's, and it reads the screen.
class XClient {
public:
    static Result<std::unique_ptr<XClient>> open(const std::string& displayName);

    // A mapped window in the upper left corner, filled with `pixel`. depth 0: the screen's.
    uint32_t makeWindow(int x, int y, int width, int height, uint32_t pixel, int depth = 0, uint32_t parent = 0);
    void destroyWindow(uint32_t window);
    void unmapWindow(uint32_t window);
    void resizeWindow(uint32_t window, int width, int height);
    void sync();

    // The visible content of a part of the window, including children and windows above. Channels without 8 bits are
    // returned as stored, at most 8 bits of them.
    Result<OwnedPicture> see(uint32_t window, int x, int y, int width, int height);
    Result<OwnedPicture> seeScreen(int x, int y, int width, int height) { return see(root(), x, y, width, height); }
    // The stored pixel itself.
    Result<uint32_t> pixelAt(uint32_t window, int x, int y);

    [[nodiscard]] uint32_t root() const { return screen().root; }
    [[nodiscard]] const xcb_screen_t& screen() const;
    xcb_connection_t* get() { return x_->get(); }

private:
    explicit XClient(std::unique_ptr<XConnection> x) : x_(std::move(x)) {}
    Result<XOwned<xcb_get_image_reply_t>> image(uint32_t window, int x, int y, int width, int height);
    std::unique_ptr<XConnection> x_;
};

} // namespace mural::test
