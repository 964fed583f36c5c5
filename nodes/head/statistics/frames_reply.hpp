// The frames in a reply of the operation `frames` of the control interface (docs/reference/statistics.md). Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "nodes/head/statistics/frame_record.hpp"

namespace mural {

// Spans and track heads of a reply, except of a reply with one frame. One takes about 45 bytes, so a reply is half as
// long as the bytes that a client may leave unread (kMaxControlUnsentBytes).
inline constexpr size_t kMaxReplySpans = 11'000;

// Returns {"frames", "next", "more"}. records: the frames from number `since` on, in order. Further frames than fit set
// `more`, and `next` is the first of them.
nlohmann::json framesReply(const std::vector<FrameRecord>& records, uint64_t since);

} // namespace mural
