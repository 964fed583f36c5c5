// The file of `mural run --frame-times`: the work of each node for each frame, as one JSON object per line
// (docs/reference/statistics.md#frame-times). Thread-safe.
#pragma once

#include <fstream>
#include <mutex>
#include <string>

#include "common/base/result.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class FrameTimesFile {
public:
    // Call before the first frame. Replaces an existing file.
    Result<void> open(const std::string& path);
    // Without effect if no file is open. After a failed write, the log names it once and the file stays as it is.
    void add(int node, const wire::FrameDoneMessage& message);

private:
    std::mutex mutex_; // guards the file; each node has a thread of its own
    std::ofstream file_;
    std::string path_;
};

} // namespace mural
