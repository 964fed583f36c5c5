// Creates the sink for a value of --out.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/picture_sink.hpp"

namespace mural {

struct OutputOptions {
    int framesPerSecond = 30; // of videos
};

enum class OutputKind { Folder, Video };

// A name with the suffix of a video is a video, unless a folder has that name or it ends with a slash. Every other name
// is a folder of PNG files. Suffixes of unsupported pictures and videos are errors, because they are never meant as
// folders.
Result<OutputKind> outputKindOf(const std::string& out);

Result<std::unique_ptr<PictureSink>> openOutput(const std::string& out, const OutputOptions& options = {});

} // namespace mural
