// The processes of `mural bench accuracy`: programs, natively and by `mural run`, on one private display.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/result.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/private_display.hpp"
#include "nodes/output/picture.hpp"

namespace mural::cli {

using Words = std::vector<std::string>;

// Removed with all that is in it.
class ScratchFolder {
public:
    static Result<ScratchFolder> make();
    ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    ScratchFolder(const ScratchFolder&) = delete;
    ~ScratchFolder();
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

class AccuracyRuns {
public:
    static Result<AccuracyRuns> open();

    // A program to its end, without Mural: what it has printed. Errors hold the last line that it said.
    [[nodiscard]] Result<std::string> native(const Words& program) const;
    // The same by `mural run OPTIONS -- PROGRAM`. frames: how many it is asked for, where that decides how long it may take.
    [[nodiscard]] Result<std::string> mural(const Words& options, const Words& program, int64_t frames = 0) const;
    // A recording, by `mural replay OPTIONS FILE`.
    [[nodiscard]] Result<std::string> replay(const Words& options, const std::string& recording) const;
    // Beside the binary; an error when it is not there.
    [[nodiscard]] static Result<std::string> scenesProgram();

private:
    AccuracyRuns(std::unique_ptr<launch::PrivateDisplay> display, ScratchFolder scratch) : display_(std::move(display)), scratch_(std::move(scratch)) {}
    [[nodiscard]] Result<std::string> perform(const Words& command, const std::string& name, int64_t limitMs) const;

    std::unique_ptr<launch::PrivateDisplay> display_;
    ScratchFolder scratch_; // what the processes say
};

// The pictures of a folder in the order of their names: .png, .ppm of 8 bits.
[[nodiscard]] Result<std::vector<OwnedPicture>> readPictures(const std::string& folder);

} // namespace mural::cli
