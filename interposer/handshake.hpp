// The first words between a program and the head (common/capture_ring.hpp). Nothing is kept open: the mapping is all
// that connects them afterwards, so a program may close or replace every descriptor.
#pragma once

#include <cstddef>

#include "common/capture_ring.hpp"

namespace mural {

struct Handshake {
    capture::Welcome welcome{};
    capture::CaptureHeader* header = nullptr; // the mapping
    char* extensions = nullptr;               // with a space before and behind each; from malloc
};

// On a connected socket, which is closed. False: the reason has been said, and nothing is held.
bool shakeHands(int socket, Handshake& result);

} // namespace mural
