// `mural head --control-fd N`: the process that owns a session.
#pragma once

namespace mural {

// Takes ownership of the descriptor. Returns the exit status: 0 after a session, 1 if it cannot start. Call from the
// main thread: the nodes live as long as the calling thread.
int runHead(int controlFd);

} // namespace mural
