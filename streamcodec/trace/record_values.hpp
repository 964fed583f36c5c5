// Number of blobs that a record consumes. Without it later records would take the wrong blobs.
#pragma once

#include "streamcodec/trace/record_walk.hpp"

namespace mural::trace {

size_t blobsTakenBy(const RecordView& record);

} // namespace mural::trace
