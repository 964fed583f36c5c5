// The state of a recording, for status and report.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace mural {

struct RecordingStatus {
    std::string file;
    int64_t firstFrame = 1; // number of the first recorded frame of the wall
    int64_t frames = 0;     // in the file
    uint64_t bytes = 0;
    bool isComplete = true; // false: an error has ended it
};

nlohmann::json recordingJson(const RecordingStatus& recording);

} // namespace mural
