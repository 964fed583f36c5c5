// Identifies the X server of a connection. A process may have connections to several servers, and their windows may
// have the same numbers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural {

// Returns the identity of the server at the other end of the socket: equal for all connections to one address, 0 if
// unknown.
uint64_t serverOf(int socket);
// Makes a display name from the peer's address, because xcb stores none. Returns false if the address has no display
// name.
bool displayNameOf(int socket, char* name, size_t bytes);

} // namespace mural
