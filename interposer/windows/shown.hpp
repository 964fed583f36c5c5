// With --display app the finished pictures reach the program's window from another X connection, up to
// `latency` frames after the swap. Before the program looks at a window or draws into it past GL, it
// waits here until its window shows what it has swapped.
#pragma once

namespace mural {

// Until every frame that this process has submitted is in its window; bounded. At once when nothing is
// under way, when pictures go elsewhere, and when there is no session.
void waitWindowsShown();

// glXWaitGL and its kin: GL drawing happens before what X does next, so a window with a single buffer
// shows it, too.
void waitGlShown();

} // namespace mural
