// How many of its stream's blobs a record takes: without them in step, later records get the wrong ones.
#pragma once

#include "recording/record_walk.hpp"

namespace mural::recording {

size_t blobsTakenBy(const RecordView& record);

} // namespace mural::recording
