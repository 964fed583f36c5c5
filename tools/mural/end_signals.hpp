// Signals that end a command in order.
#pragma once

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::cli {

// Returns a descriptor that is readable after SIGINT, SIGTERM or SIGHUP. Call before any thread starts.
Result<FileDescriptor> endSignals();

} // namespace mural::cli
