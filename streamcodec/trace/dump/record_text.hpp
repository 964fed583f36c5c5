// Formats a record as a call: its name, named arguments, and enum names of the registry.
#pragma once

#include <string>

#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/trace/stream_blobs.hpp"

namespace mural::trace {

// Returns "glClear", "Mural.Swap", or "opcode 99".
std::string recordName(uint16_t opcode);

// Returns "glClear(mask=GL_COLOR_BUFFER_BIT)". Consumes the record's blobs. Unreadable records end with "...,
// malformed".
std::string recordText(const wire::RecordView& record, StreamBlobs& blobs);

} // namespace mural::trace
