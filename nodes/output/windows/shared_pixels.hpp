// Memory shared with a local X server for pictures (MIT-SHM with descriptors).
#pragma once

#include <cstddef>
#include <memory>

#include <xcb/shm.h>

#include "nodes/output/windows/x_connection.hpp"

namespace mural {

class SharedPixels {
public:
    // Null without server support: a remote server, no MIT-SHM 1.2, no permission. Not an error.
    static std::unique_ptr<SharedPixels> attach(XConnection& x, size_t sizeBytes, Deadline deadline);
    SharedPixels(const SharedPixels&) = delete;
    SharedPixels& operator=(const SharedPixels&) = delete;
    ~SharedPixels();

    [[nodiscard]] std::byte* data() const { return data_; }
    [[nodiscard]] size_t sizeBytes() const { return sizeBytes_; }
    [[nodiscard]] xcb_shm_seg_t segment() const { return segment_; }

private:
    SharedPixels(XConnection& x, std::byte* data, size_t sizeBytes) : x_(x), data_(data), sizeBytes_(sizeBytes) {}

    XConnection& x_;
    std::byte* data_;
    size_t sizeBytes_;
    xcb_shm_seg_t segment_ = 0; // 0: not attached
};

} // namespace mural
