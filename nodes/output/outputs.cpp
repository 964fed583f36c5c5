#include "nodes/output/outputs.hpp"

#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "common/log/log.hpp"
#include "nodes/output/files/png_files.hpp"
#include "nodes/output/files/video_encoders.hpp"
#include "nodes/output/files/video_file.hpp"

namespace mural {

namespace {

constexpr std::array kOtherSuffixes = {"png", "jpg", "jpeg", "gif", "bmp", "tif", "tiff", "webp",
                                       "ppm", "mpg", "mpeg", "wmv", "flv", "m4v", "ogv",  "ts"};

template <class Sink> Result<std::unique_ptr<PictureSink>> asSink(Result<std::unique_ptr<Sink>> opened) {
    if (!opened) return opened.error();
    return std::unique_ptr<PictureSink>(std::move(opened.value()));
}

} // namespace

Result<OutputKind> outputKindOf(const std::string& out) {
    if (out.empty()) return Error{"--out needs a folder or a video file, e.g. --out pictures or --out run.mp4"};
    std::error_code error;
    if (out.back() == '/' || std::filesystem::is_directory(out, error)) return OutputKind::Folder;
    const std::string suffix = suffixOf(out);
    if (isVideoSuffix(suffix)) return OutputKind::Video;
    for (const char* other : kOtherSuffixes) {
        if (suffix != other) continue;
        return Error{fmt::format("--out {}: .{} files are not written; give a folder for PNG "
                                 "files, or a video as .mp4, .mkv, .avi, .webm or .mov",
                                 out, suffix)};
    }
    return OutputKind::Folder;
}

Result<std::unique_ptr<PictureSink>> openOutput(const std::string& out, const OutputOptions& options) {
    Result<OutputKind> kind = outputKindOf(out);
    if (!kind) return kind.error();
    log::debug(log::Topic::Output, kind.value() == OutputKind::Folder ? "folder of pictures: " : "video: ", out);
    if (kind.value() == OutputKind::Folder) return asSink(PngFiles::open(out));
    VideoConfig config;
    config.path = out;
    config.framesPerSecond = options.framesPerSecond;
    return asSink(VideoFile::open(std::move(config)));
}

} // namespace mural
