// Plays a trace in place of its programs; the head cannot tell the difference. The program of `mural replay`.
#pragma once

#include <string>

namespace mural {

struct PlayOptions {
    std::string file;
    std::string session; // the head's socket
    bool pace = false;   // keeps the recorded timing of packets
    bool loop = false;   // repeats forever
};

// Returns the exit status: 0; 1 if the session ends early; 2 for an unreadable trace. Errors go to stderr.
int playRecording(const PlayOptions& options);

} // namespace mural
