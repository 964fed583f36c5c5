// Waits until the program's windows show its frames. With --display app, finished pictures reach the program's window
// on another X connection, up to `latency` frames after the swap. A program that reads a window, or draws into it
// without GL, waits here until the window shows the swapped frame.
#pragma once

namespace mural {

// Waits, with a limit, until every submitted frame of this process is in its window. Returns at once without pending
// frames, without --display app, and without a session.
void waitWindowsShown();

// Do the same before a read of an image, and before a copy from this drawable. The program's windows show no overlay
// from then on. Toolkits copy from pixmaps in each frame, so only copies from windows with pictures count.
void waitBeforeRead();
void waitBeforeCopy(unsigned long drawable);

// For glXWaitGL and similar calls: GL draws precede later X draws, so single-buffered windows are shown too.
void waitGlShown();

} // namespace mural
