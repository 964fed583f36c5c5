// The statistics of frames of one session, as its head reports them (docs/reference/statistics.md). Pure.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/head/statistics/frame_record.hpp"

namespace mural::cli {

struct SessionFrames {
    nlohmann::json status;           // nodes/head/session/session_status.hpp
    nlohmann::json clocks;           // [{"node", "offsetNs", "errorNs"}]; without nodes of unknown clocks
    std::vector<FrameRecord> frames; // in the order of their numbers
    uint64_t next = 1;               // number of the first frame of the next reply
    bool hasMore = false;            // the head has further frames now
    nlohmann::json outputs;          // reply of the operation `outputs`; null: not requested
};

// Adds the frames of a reply, and replaces the other members. Errors: the reply is invalid.
Result<void> addReply(SessionFrames& frames, const nlohmann::json& reply);

// Drops the first frames that lack threads of later frames: they were in progress when the statistics began.
void dropPartialBegin(SessionFrames& frames);

} // namespace mural::cli
