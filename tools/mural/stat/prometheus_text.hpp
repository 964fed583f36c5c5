// The state and the statistics of sessions in the text format of Prometheus, version 0.0.4. Pure.
#pragma once

#include <string>
#include <vector>

#include "tools/mural/stat/session_frames.hpp"

namespace mural::cli {

// Returns all metrics; docs/reference/statistics.md lists them.
std::string prometheusText(const std::vector<SessionFrames>& sessions);

} // namespace mural::cli
