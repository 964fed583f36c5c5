// Windows in place of the recorded program's windows (--display app). The head shows pictures in them. Used by one
// thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/base/result.hpp"
#include "nodes/output/windows/window_owner.hpp"
#include "nodes/output/windows/x_connection.hpp"

namespace mural {

class PlayerWindows {
public:
    // session: the name of the session that shows pictures in the windows.
    PlayerWindows(std::string title, const std::string& session);
    // Creates or resizes the window to that size. Returns its id on the display. clientNow: the program's number in
    // this session.
    Result<uint32_t> show(uint32_t client, uint32_t clientNow, uint32_t window, uint32_t width, uint32_t height);
    void destroy(uint32_t client, uint32_t window);

private:
    Result<void> open();
    Result<uint32_t> make(const WindowOwner& owner, uint32_t width, uint32_t height);

    const std::string title_;
    const uint64_t sessionKey_;
    std::unique_ptr<XConnection> x_; // created with the first window
    std::map<std::pair<uint32_t, uint32_t>, xcb_window_t> windows_;
};

} // namespace mural
