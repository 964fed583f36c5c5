// Grabs of X servers by this process. During a grab the server serves the grabbing connection only. The head's pictures
// then cannot reach the program's windows, so the program puts them itself (interposer/x11/own_puts.hpp).
#pragma once

#include <cstdint>
#include <xcb/xcb.h>

namespace mural {

struct Window;

// Returns the connection that holds or has requested a grab of the window's server; null: none. Any thread may call it.
xcb_connection_t* grabbingConnection(const Window& w);

// Queries the window's size through the grabbing connection, because the server answers no other one. Returns false if
// there is no grab or no such window.
bool querySizeDuringGrab(const Window& w, uint32_t& width, uint32_t& height);

} // namespace mural
