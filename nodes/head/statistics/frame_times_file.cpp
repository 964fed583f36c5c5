#include "nodes/head/statistics/frame_times_file.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>

#include "common/log/log.hpp"

namespace mural {

Result<void> FrameTimesFile::open(const std::string& path) {
    path_ = path;
    file_.open(path, std::ios::binary | std::ios::trunc);
    if (!file_.is_open())
        return Error{
            fmt::format("--frame-times {}: cannot be written: {}; choose another place", path, std::strerror(errno))};
    return {};
}

void FrameTimesFile::add(int node, const wire::FrameDoneMessage& m) {
    const std::lock_guard lock(mutex_);
    if (!file_.is_open()) return;
    file_ << fmt::format(
        R"({{"client":{},"window":{},"frame":{},"width":{},"height":{},"node":{},"busySeconds":{:.9f}}})"
        "\n",
        m.client, m.window, m.frame, m.width, m.height, node, static_cast<double>(m.busyNs) / 1e9);
    if (file_) return;
    log::warning(log::Topic::Session, "--frame-times ", path_, ": ", std::strerror(errno),
                 "; the file ends with an earlier frame");
    file_.close();
}

} // namespace mural
