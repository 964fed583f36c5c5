// A connection to the X display of a program. Calls block while the X server does not answer.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include <xcb/xcb.h>

#include "nodes/input/program_display.hpp"

namespace mural::input {

struct FreeReply {
    void operator()(void* reply) const { std::free(reply); }
};
template <class Reply> using Answer = std::unique_ptr<Reply, FreeReply>;

struct Disconnect {
    void operator()(xcb_connection_t* connection) const { xcb_disconnect(connection); }
};
using XConnection = std::unique_ptr<xcb_connection_t, Disconnect>;

// Returns null if the display cannot be opened.
[[nodiscard]] XConnection connectTo(const ProgramDisplay& display);
[[nodiscard]] xcb_window_t rootOf(xcb_connection_t* connection);
// Returns the largest window that is shown directly on the root.
[[nodiscard]] xcb_window_t largestWindow(xcb_connection_t* connection);

} // namespace mural::input
