// A video file, written by a child process `ffmpeg`. Lossless: the decoded video has the exact drawn values. Every
// shown frame is one frame of the video, at a fixed rate.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/files/encoder_process.hpp"
#include "nodes/output/picture_sink.hpp"
#include "nodes/output/files/video_encoders.hpp"

namespace mural {

struct VideoConfig {
    std::string path; // suffix .mp4 .mkv .avi .webm or .mov
    int framesPerSecond = 30;
    std::string program = "ffmpeg";
    int64_t frameTimeoutMs = 10'000;   // limit for the encoder to accept a frame
    int64_t finishTimeoutMs = 120'000; // encoders buffer frames
};

class VideoFile : public PictureSink {
public:
    // Finds ffmpeg and its encoders. The first picture creates the file.
    static Result<std::unique_ptr<VideoFile>> open(VideoConfig config);
    ~VideoFile() override; // completes the file within a short limit

    // A picture of another size ends the file and starts "NAME-2.SUFFIX". After a failure all further calls fail.
    Result<void> show(int64_t frame, const Picture& picture) override;
    Result<void> finish() override;
    [[nodiscard]] std::string describe() const override;

    [[nodiscard]] const std::string& currentPath() const { return currentPath_; }
    [[nodiscard]] int64_t framesWritten() const { return framesWritten_; }
    // Of the running encoder; -1: none.
    [[nodiscard]] pid_t encoderPid() const { return encoder_ ? encoder_->pid() : -1; }

private:
    VideoFile(VideoConfig config, VideoEncoding encoding)
        : config_(std::move(config)), encoding_(std::move(encoding)) {}

    Result<void> append(int64_t frame, const Picture& picture);
    Result<void> begin(int width, int height);
    Result<void> end(int64_t timeoutMs);
    [[nodiscard]] std::string numberedPath() const;

    VideoConfig config_; // program: its full path
    VideoEncoding encoding_;
    std::unique_ptr<EncoderProcess> encoder_;
    std::optional<Error> failure_;
    std::string currentPath_;
    int width_ = 0;
    int height_ = 0;
    int files_ = 0;
    int64_t framesWritten_ = 0;
};

} // namespace mural
