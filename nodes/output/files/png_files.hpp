// Pictures as PNG files: RGB, 8 bits per channel, with the exact drawn values.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/picture_sink.hpp"

namespace mural {

// The file gets its name only after it is complete.
Result<void> writePng(const std::string& path, const Picture& picture);

// Reads any PNG. 16-bit channels are truncated to 8 bits, transparency is dropped, colours are not converted.
Result<OwnedPicture> readPng(const std::string& path);

// Writes frame-000001.png etc. into one folder, numbered by frame.
class PngFiles : public PictureSink {
public:
    // Creates the folder and its parents if missing.
    static Result<std::unique_ptr<PngFiles>> open(const std::string& folder);

    Result<void> show(int64_t frame, const Picture& picture) override;
    Result<void> finish() override { return {}; }
    [[nodiscard]] std::string describe() const override;

    [[nodiscard]] int64_t filesWritten() const { return filesWritten_; }
    [[nodiscard]] const std::string& lastPath() const { return lastPath_; } // empty: none yet

private:
    explicit PngFiles(std::string folder) : folder_(std::move(folder)) {}

    std::string folder_;
    std::string lastPath_;
    int64_t filesWritten_ = 0;
};

} // namespace mural
