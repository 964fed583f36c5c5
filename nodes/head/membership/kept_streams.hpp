// The state that the rejoin log keeps, by kind of program (RejoinLog::MakeStream).
#pragma once

#include <cstddef>
#include <memory>

#include "streamcodec/snapshot/kept_stream.hpp"

namespace mural {

// For captured programs: the live GL commands.
std::unique_ptr<snapshot::KeptStream> makeCapturedStream(size_t maxBytes);
// For programs with the native API: the newest version of every object, the windows, and the latest frame.
// `isOneMachine`: nodes map blobs of the head.
std::unique_ptr<snapshot::KeptStream> makeNativeStream(size_t maxBytes, bool isOneMachine = false);

} // namespace mural
