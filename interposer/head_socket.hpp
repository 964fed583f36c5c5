// Opens the connection to the head of this process's session.
#pragma once

namespace mural {

// A connected stream socket (close-on-exec, timeouts of 30 s), owned by the caller; -1: no head is reachable, which has
// been said in one line. The head's abstract socket comes first; it belongs to a network namespace, so in another one the
// socket in the file system serves.
int openHeadSocket();

} // namespace mural
