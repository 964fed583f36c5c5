#include "nodes/output/files/video_file.hpp"

#include <filesystem>
#include <span>

#include <fmt/format.h>

#include "common/log/log.hpp"

namespace mural {

namespace {

constexpr int64_t kListTimeoutMs = 20'000;
constexpr int64_t kDestructorTimeoutMs = 3'000;

Result<std::set<std::string>> listEncoders(const std::string& program) {
    auto process = EncoderProcess::start({program, "-hide_banner", "-encoders"});
    if (!process) return process.error();
    Result<void> finished = process.value()->finish(Deadline::inMs(kListTimeoutMs));
    if (!finished) return finished.error();
    return encodersIn(process.value()->output());
}

// Detects errors early that ffmpeg would report after the first picture.
Result<void> checkFolder(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) {
        return Error{fmt::format("cannot make the folder {} for the video: {}; choose another one "
                                 "with --out",
                                 folder.string(), error.message())};
    }
    if (std::filesystem::is_directory(path, error))
        return Error{fmt::format("cannot write the video {}: that is a folder; choose another "
                                 "name with --out",
                                 path)};
    return {};
}

} // namespace

Result<std::unique_ptr<VideoFile>> VideoFile::open(VideoConfig config) {
    const std::string suffix = suffixOf(config.path);
    if (!isVideoSuffix(suffix)) return chooseEncoding(suffix, {}).error();
    const std::string program = findProgram(config.program);
    if (program.empty()) {
        return Error{fmt::format("cannot write the video {}: no program '{}' in PATH; install "
                                 "Debian's package ffmpeg, or give --out a folder for PNG files",
                                 config.path, config.program)};
    }
    if (Result<void> folder = checkFolder(config.path); !folder) return folder.error();
    Result<std::set<std::string>> encoders = listEncoders(program);
    if (!encoders) return encoders.error();
    Result<VideoEncoding> encoding = chooseEncoding(suffix, encoders.value());
    if (!encoding) return encoding.error();
    config.program = program;
    return std::unique_ptr<VideoFile>(new VideoFile(std::move(config), encoding.value()));
}

VideoFile::~VideoFile() { (void)end(kDestructorTimeoutMs); }

Result<void> VideoFile::show(int64_t frame, const Picture& picture) {
    if (failure_) return *failure_;
    Result<void> appended = append(frame, picture);
    if (!appended) {
        failure_ = appended.error();
        encoder_.reset(); // the stream may have ended within a frame
    }
    return appended;
}

Result<void> VideoFile::append(int64_t frame, const Picture& picture) {
    if (picture.empty()) return Error{fmt::format("frame {} is empty: nothing to write to {}", frame, config_.path)};
    if (encoder_ && (picture.width != width_ || picture.height != height_)) {
        const std::string before = currentPath_;
        if (Result<void> ended = end(config_.finishTimeoutMs); !ended) return ended;
        log::info(log::Topic::Output, "the picture changed from ", width_, "x", height_, " to ", picture.width, "x",
                  picture.height, " at frame ", frame, ": ", before, " is complete, the video goes on in ",
                  numberedPath());
    }
    if (!encoder_) {
        if (Result<void> begun = begin(picture.width, picture.height); !begun) return begun;
    }
    Result<void> written =
        encoder_->write(std::span(picture.bgra, picture.sizeBytes()), Deadline::inMs(config_.frameTimeoutMs));
    if (!written) {
        return Error{fmt::format("cannot write frame {} to {}: {}; check the disk, or choose "
                                 "another --out",
                                 frame, currentPath_, written.error().message)};
    }
    ++framesWritten_;
    return {};
}

Result<void> VideoFile::finish() { return end(config_.finishTimeoutMs); }

std::string VideoFile::describe() const {
    return fmt::format("video {} ({}, lossless, {} frames per second)", config_.path, encoding_.encoder,
                       config_.framesPerSecond);
}

std::string VideoFile::numberedPath() const {
    if (files_ == 0) return config_.path;
    const std::filesystem::path path(config_.path);
    const std::string name = fmt::format("{}-{}{}", path.stem().string(), files_ + 1, path.extension().string());
    return (path.parent_path() / name).string();
}

Result<void> VideoFile::begin(int width, int height) {
    currentPath_ = numberedPath();
    ++files_;
    width_ = width;
    height_ = height;
    std::vector<std::string> arguments = {
        // -xerror: without it ffmpeg 5.1 exits with 0 if the disk is full at the end of a short .mkv.
        config_.program, "-hide_banner", "-nostats", "-loglevel", "error", "-xerror", "-y",
        // The input has its bottom row first, hence vflip.
        "-f", "rawvideo", "-pixel_format", "bgr0", "-video_size", fmt::format("{}x{}", width, height), "-framerate",
        std::to_string(config_.framesPerSecond), "-i", "pipe:0", "-vf", "vflip"};
    arguments.insert(arguments.end(), encoding_.arguments.begin(), encoding_.arguments.end());
    // "file:" protects names with a colon or a leading minus.
    arguments.push_back("file:" + currentPath_);
    Result<std::unique_ptr<EncoderProcess>> started = EncoderProcess::start(arguments);
    if (!started) return started.error();
    encoder_ = std::move(started.value());
    log::debug(log::Topic::Output, currentPath_, ": ", encoding_.encoder, " begins, ", width, "x", height, ", pid ",
               encoder_->pid());
    return {};
}

Result<void> VideoFile::end(int64_t timeoutMs) {
    if (!encoder_) return {};
    Result<void> finished = encoder_->finish(Deadline::inMs(timeoutMs));
    encoder_.reset();
    log::debug(log::Topic::Output, currentPath_, finished ? " is complete, " : " is incomplete, ", framesWritten_,
               " frames so far");
    if (finished) return {};
    return Error{fmt::format("the video {} is not complete: {}", currentPath_, finished.error().message)};
}

} // namespace mural
