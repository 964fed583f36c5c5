// Opens the connection to the head of this process's session.
#pragma once

namespace mural {

// Returns a connected stream socket (close-on-exec, timeouts of 30 s), owned by the caller. -1: no head is reachable;
// one line has reported this. The head's abstract socket is tried first. It belongs to a network namespace, so other
// namespaces use the socket in the file system.
int openHeadSocket();

} // namespace mural
