// From the text of --out to where the pictures go.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/result.hpp"
#include "nodes/output/picture_sink.hpp"

namespace mural {

struct OutputOptions {
    int framesPerSecond = 30;                    // of videos
    std::function<void(const std::string&)> say; // one line for the user; may be empty
};

enum class OutputKind { Folder, Video };

// A name with the suffix of a video is a video, unless a folder has that name already or it ends
// with a slash; everything else is a folder of PNG files. Suffixes of pictures and of videos that
// we don't write are errors: nobody wants a folder of that name.
Result<OutputKind> outputKindOf(const std::string& out);

Result<std::unique_ptr<PictureSink>> openOutput(const std::string& out,
                                                const OutputOptions& options = {});

} // namespace mural
