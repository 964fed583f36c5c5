#include "nodes/output/files/video_encoders.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

namespace mural {

namespace {

// All of these store R, G and B unchanged, without conversion to Y'CbCr.
const VideoEncoding kX264{"libx264rgb", {"-c:v", "libx264rgb", "-preset", "ultrafast", "-qp", "0"}};
const VideoEncoding kFfv1{"ffv1", {"-c:v", "ffv1", "-level", "3", "-pix_fmt", "bgr0"}};
const VideoEncoding kQuickTime{"qtrle", {"-c:v", "qtrle", "-pix_fmt", "rgb24"}};
const VideoEncoding kPng{"png", {"-c:v", "png", "-pix_fmt", "rgb24"}};
const VideoEncoding kVp9{"libvpx-vp9",
                         {"-c:v", "libvpx-vp9", "-lossless", "1", "-pix_fmt", "gbrp", "-deadline", "realtime",
                          "-cpu-used", "8", "-row-mt", "1"}};

struct Container {
    const char* suffix;
    std::vector<VideoEncoding> encodings; // best first
};

const std::array<Container, 5>& containers() {
    static const std::array<Container, 5> all{{
        {"mp4", {kX264, kPng}},
        {"mkv", {kX264, kFfv1}},
        {"avi", {kX264, kFfv1}},
        {"mov", {kX264, kQuickTime, kPng}},
        {"webm", {kVp9}},
    }};
    return all;
}

const Container* findContainer(const std::string& suffix) {
    for (const Container& container : containers())
        if (suffix == container.suffix) return &container;
    return nullptr;
}

} // namespace

std::string suffixOf(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    if (!suffix.empty()) suffix.erase(0, 1);
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

bool isVideoSuffix(const std::string& suffix) { return findContainer(suffix) != nullptr; }

// Lines look like " V....D libx264rgb           libx264 H.264 …"; the legend before them contains " = ".
std::set<std::string> encodersIn(const std::string& listing) {
    std::set<std::string> names;
    std::istringstream lines(listing);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string flags;
        std::string name;
        if (words >> flags >> name && flags.size() == 6 && flags[0] == 'V' && name != "=") names.insert(name);
    }
    return names;
}

Result<VideoEncoding> chooseEncoding(const std::string& suffix, const std::set<std::string>& encoders) {
    const Container* container = findContainer(suffix);
    if (container == nullptr) {
        return Error{fmt::format("no video format for the suffix '.{}'; use .mp4, .mkv, .avi, "
                                 ".webm or .mov",
                                 suffix)};
    }
    std::string wanted;
    for (const VideoEncoding& encoding : container->encodings) {
        if (encoders.count(encoding.encoder) != 0) return encoding;
        wanted += (wanted.empty() ? "" : " or ") + encoding.encoder;
    }
    return Error{fmt::format("this ffmpeg has no lossless encoder for .{} ({}); install Debian's "
                             "package ffmpeg, or write another format",
                             suffix, wanted)};
}

} // namespace mural
