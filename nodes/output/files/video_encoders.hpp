// Selects ffmpeg's lossless encoder for a container. Pure.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural {

struct VideoEncoding {
    std::string encoder;                // ffmpeg's name
    std::vector<std::string> arguments; // between the input's arguments and the file name
};

// The suffix of `path` in lower case without its dot; empty: none.
std::string suffixOf(const std::string& path);

// True for the suffixes that VideoFile supports: mp4 mkv avi webm mov.
bool isVideoSuffix(const std::string& suffix);

// The names in the output of `ffmpeg -hide_banner -encoders`.
std::set<std::string> encodersIn(const std::string& listing);

// The fastest available lossless encoding for the container.
Result<VideoEncoding> chooseEncoding(const std::string& suffix, const std::set<std::string>& encoders);

} // namespace mural
