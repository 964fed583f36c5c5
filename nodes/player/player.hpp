// Plays a recording as if its programs ran: a session's head can't tell the difference. The program of `mural replay`.
#pragma once

#include <string>

namespace mural {

struct PlayOptions {
    std::string file;
    std::string session; // the head's socket
    bool pace = false;   // packets at the times at which they were recorded
    bool loop = false;   // again and again
};

// Returns the exit status: 0, 1 when the session does not go on, 2 when the recording can't be read. Errors go to stderr.
int playRecording(const PlayOptions& options);

} // namespace mural
