// Number of blobs that a record consumes. Without it later records would take the wrong blobs.
#pragma once

#include "streamcodec/wire/record_walk.hpp"

namespace mural::wire {

size_t blobsTakenBy(const RecordView& record);

} // namespace mural::wire
