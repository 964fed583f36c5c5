// Which encoder of ffmpeg stores pictures without any loss in which container. Pure.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural {

struct VideoEncoding {
    std::string encoder;                // as ffmpeg names it
    std::vector<std::string> arguments; // after the input's, before the file's name
};

// The suffix of `path` in lower case without its dot; empty when there is none.
std::string suffixOf(const std::string& path);

// True for the suffixes that VideoFile writes: mp4 mkv avi webm mov.
bool isVideoSuffix(const std::string& suffix);

// Names from the output of `ffmpeg -hide_banner -encoders`.
std::set<std::string> encodersIn(const std::string& listing);

// The fastest lossless encoding for the container among those that are there.
Result<VideoEncoding> chooseEncoding(const std::string& suffix,
                                     const std::set<std::string>& encoders);

} // namespace mural
