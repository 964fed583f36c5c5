// Detects X windows that are destroyed without a request that names them. The server destroys children with their
// parents, and all windows of a killed connection. After such a request the interposer queries the server for the known
// windows. It does not wait for the replies, because another connection may have grabbed the server. It reads them at
// the next frame.
#pragma once

#include <atomic>
#include <cstdint>
#include <xcb/xcb.h>

struct _XDisplay; // NOLINT(bugprone-reserved-identifier): the name is Xlib's

namespace mural {

struct Window;

namespace gone_windows {
extern std::atomic<int> pending;
}
[[nodiscard]] inline bool hasWindowRequests() { return gone_windows::pending.load(std::memory_order_relaxed) > 0; }

// Call it after a request of this connection that may have destroyed windows.
void requestWindowAttributes(xcb_connection_t* connection);
void requestWindowAttributes(_XDisplay* display);
// Takes the replies that have arrived and ends the windows that the server does not have.
void takeGoneWindows();
// Call it when the program binds a destroyed window again: the number may belong to a new window. Waits for the reply.
void checkForDestroyed(Window& w);
// Drops the pending queries of a closing connection and ends the windows that it has created.
void connectionCloses(xcb_connection_t* connection);

} // namespace mural
