// The handshake between a program and the head (common/ipc/capture_ring.hpp). No descriptor stays open: only the
// mapping connects them afterwards. A program may therefore close or replace every descriptor.
#pragma once

#include <cstddef>

#include "common/ipc/capture_ring.hpp"

namespace mural {

struct Handshake {
    capture::Welcome welcome{};
    capture::CaptureHeader* header = nullptr; // the mapping
    char* extensions = nullptr;               // each surrounded by spaces; from malloc
};

// Does the handshake on a connected socket, and closes the socket. Returns false after an error, which has been
// reported; `result` then holds no resources.
bool shakeHands(int socket, Handshake& result);

} // namespace mural
