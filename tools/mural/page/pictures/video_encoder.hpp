// Encodes the pictures of one class as H.264 for WebCodecs: constrained baseline, one slice, no reordering, and key
// frames on request alone. Not thread-safe.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/picture.hpp"

namespace mural::page {

struct VideoUnit {
    std::string bytes; // one access unit with start codes; a key frame begins with its parameter sets
    bool isKeyFrame = false;
    int width = 0, height = 0; // even
};

class VideoEncoder {
public:
    VideoEncoder();
    VideoEncoder(const VideoEncoder&) = delete;
    VideoEncoder& operator=(const VideoEncoder&) = delete;
    ~VideoEncoder();

    // Requires Bgra8, and the limits of OpenH264: kMaxSide and kMaxPixels. A picture of another size is a key frame.
    // Odd sizes lose their last column or row.
    Result<VideoUnit> encode(const Picture& picture, bool isKeyFrame);

    static constexpr int kMaxSide = 3840, kMinSide = 16;
    static constexpr int64_t kMaxPixels = int64_t{3840} * 2160;
    [[nodiscard]] static bool canEncode(int width, int height) {
        return width >= kMinSide && height >= kMinSide && width <= kMaxSide && height <= kMaxSide &&
               int64_t{width} * height <= kMaxPixels;
    }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace mural::page
