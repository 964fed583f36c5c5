// A record as a call: its name, its arguments by name, enums as the registry calls them.
#pragma once

#include <string>

#include "recording/record_walk.hpp"
#include "recording/stream_blobs.hpp"

namespace mural::recording {

// "glClear", "Mural.Swap", or "opcode 99".
std::string recordName(uint16_t opcode);

// "glClear(mask=GL_COLOR_BUFFER_BIT)". Takes the record's blobs. What can't be read is "…, malformed".
std::string recordText(const RecordView& record, StreamBlobs& blobs);

} // namespace mural::recording
