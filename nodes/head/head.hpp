// `mural head --control-fd N`: the process that owns a session.
#pragma once

namespace mural {

// Takes over the descriptor. Returns the exit status: 0 after a session, 1 when it can't start.
// Call from the main thread: the nodes live as long as the calling thread.
int runHead(int controlFd);

} // namespace mural
