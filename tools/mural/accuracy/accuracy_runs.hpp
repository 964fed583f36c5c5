// Runs programs for `mural bench accuracy`, natively and by `mural run`, on one private display.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/private_display.hpp"
#include "nodes/output/picture.hpp"
#include "tools/mural/child_runs/scratch_folder.hpp"

namespace mural::cli {

using Words = std::vector<std::string>;

class AccuracyRuns {
public:
    static Result<AccuracyRuns> open();

    // Runs a program without Mural and returns its output. Errors contain its last line.
    [[nodiscard]] Result<std::string> native(const Words& program) const;
    // The same by `mural run OPTIONS -- PROGRAM`. frames: number of frames, which extends the timeout.
    [[nodiscard]] Result<std::string> mural(const Words& options, const Words& program, int64_t frames = 0) const;
    // Replays a trace by `mural replay OPTIONS FILE`.
    [[nodiscard]] Result<std::string> replay(const Words& options, const std::string& recording) const;
    // Returns the path next to the binary, or an error.
    [[nodiscard]] static Result<std::string> scenesProgram();

private:
    AccuracyRuns(std::unique_ptr<launch::PrivateDisplay> display, ScratchFolder scratch)
        : display_(std::move(display)), scratch_(std::move(scratch)) {}
    [[nodiscard]] Result<std::string> perform(const Words& command, const std::string& name, int64_t limitMs) const;

    std::unique_ptr<launch::PrivateDisplay> display_;
    ScratchFolder scratch_; // output of the processes
};

// Reads the pictures of a folder, sorted by name: .png, and 8-bit .ppm.
[[nodiscard]] Result<std::vector<OwnedPicture>> readPictures(const std::string& folder);

} // namespace mural::cli
