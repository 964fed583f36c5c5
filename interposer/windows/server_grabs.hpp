// Grabs of X servers by this process. While one lasts the server serves the grabbing connection alone, so the head's
// pictures do not reach the program's windows: the program puts them itself (interposer/windows/own_puts.hpp).
#pragma once

#include <cstdint>
#include <xcb/xcb.h>

namespace mural {

struct Window;

// The connection that holds, or has asked for, a grab of the server of this window; null: none. Any thread.
xcb_connection_t* grabbingConnection(const Window& w);

// The window's size through that connection: the server would not answer the one that GL uses, if it is another. False:
// there is no grab, or no such window.
bool askSizeDuringGrab(const Window& w, uint32_t& width, uint32_t& height);

} // namespace mural
