// Number of blobs that a record consumes. Without it later records would take the wrong blobs.
#pragma once

#include "recording/record_walk.hpp"

namespace mural::recording {

size_t blobsTakenBy(const RecordView& record);

} // namespace mural::recording
