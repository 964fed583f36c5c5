// Checks whether a captured program draws in an X window (common/ipc/window_mark.hpp). For one thread.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/output/windows/x_connection.hpp"

namespace mural {

// A drawable of a program, as named in its stream.
struct WindowOwner {
    uint64_t sessionKey = 0;
    uint32_t client = 0, window = 0;
};

class WindowOwnerCheck {
public:
    explicit WindowOwnerCheck(WindowOwner owner) : owner_(owner) {}
    enum class Owned { Yes, No, WindowGone };
    // Takes one round trip, the first time two. Errors: the connection fails.
    Result<Owned> owns(XConnection& x, xcb_window_t window, Deadline deadline);

private:
    Result<void> findProperty(XConnection& x, Deadline deadline);

    const WindowOwner owner_;
    xcb_atom_t property_ = XCB_ATOM_NONE; // none: the server has no such atom yet
};

// Marks a window that a process of Mural has created in place of the program.
Result<void> markWindow(XConnection& x, xcb_window_t window, const WindowOwner& owner, Deadline deadline);

} // namespace mural
