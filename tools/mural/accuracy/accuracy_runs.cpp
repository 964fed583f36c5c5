#include "tools/mural/accuracy/accuracy_runs.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include "common/install/library_folder.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/process_tree.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/output/files/png_files.hpp"
#include "tools/mural/child_runs/end_processes.hpp"
#include "tools/mural/child_runs/interruption.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kRunMs = 300'000; // timeout of one run; slow machines need a tenth
constexpr int64_t kFrameMs = 1'000; // additional time per requested frame
constexpr int64_t kEndMs = 10'000;
constexpr int64_t kTurnMs = 50;

std::string textOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string lastLine(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);
}

// Returns true if the process has ended by itself, false if it must be ended.
bool awaitEnd(launch::ChildProcess& child, Deadline limit) {
    while (!child.waitUntil(Deadline::inMs(kTurnMs)))
        if (limit.passed() || Interruption::signal() != 0) return false;
    return true;
}

Result<OwnedPicture> readPpm(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string magic;
    int width = 0, height = 0, maximum = 0;
    file >> magic >> width >> height >> maximum;
    file.get();
    constexpr int kLargest = 1 << 16;
    if (!file || magic != "P6" || maximum != 255 || width <= 0 || height <= 0 || width > kLargest || height > kLargest)
        return Error{path + " is not a PPM picture with 8 bits; check for a full disk"};
    OwnedPicture picture(width, height);
    std::vector<char> row(static_cast<size_t>(width) * 3);
    for (int y = height; y-- > 0;) { // files begin with the top row
        if (!file.read(row.data(), static_cast<std::streamsize>(row.size())))
            return Error{path + " ends too early; check for a full disk"};
        for (size_t x = 0; x < static_cast<size_t>(width); ++x)
            for (size_t c = 0; c < 4; ++c)
                picture.row(y)[4 * x + c] = c < 3 ? static_cast<std::byte>(row[3 * x + 2 - c]) : std::byte{255};
    }
    return picture;
}

} // namespace

Result<AccuracyRuns> AccuracyRuns::open() {
    auto scratch = ScratchFolder::make();
    if (!scratch) return scratch.error();
    launch::adoptOrphans(); // for endWithAll()
    auto display = launch::PrivateDisplay::start(launch::kDefaultScreenWidth, launch::kDefaultScreenHeight);
    if (!display) return display.error();
    return AccuracyRuns(std::move(*display), std::move(*scratch));
}

Result<std::string> AccuracyRuns::native(const Words& program) const {
    return perform(program, program.front(), kRunMs);
}

Result<std::string> AccuracyRuns::mural(const Words& options, const Words& program, int64_t frames) const {
    Words command{launch::ownBinary(), "run", "--quiet", "--display", "none"};
    std::string name = "mural run";
    for (const std::string& o : options) name += " " + o;
    command.insert(command.end(), options.begin(), options.end());
    command.emplace_back("--");
    command.insert(command.end(), program.begin(), program.end());
    return perform(command, name, kRunMs + frames * kFrameMs);
}

Result<std::string> AccuracyRuns::replay(const Words& options, const std::string& recording) const {
    Words command{launch::ownBinary(), "replay", "--quiet", "--display", "none"};
    std::string name = "mural replay";
    for (const std::string& o : options) name += " " + o;
    command.insert(command.end(), options.begin(), options.end());
    command.push_back(recording);
    return perform(command, name, kRunMs);
}

Result<std::string> AccuracyRuns::perform(const Words& command, const std::string& name, int64_t limitMs) const {
    if (Interruption::signal() != 0) return Error{name + " was not started: the measurement was interrupted"};
    const std::string output = scratch_.path() + "/said", errors = scratch_.path() + "/complained";
    launch::SpawnRequest request;
    request.file = command.front();
    request.arguments = command;
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    display_->use(environment);
    request.environment = environment.entries();
    request.outputFd = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    request.errorFd = ::open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    request.signalWhenWeDie = SIGTERM;
    auto child =
        request.outputFd >= 0 && request.errorFd >= 0
            ? launch::ChildProcess::start(request)
            : Result<launch::ChildProcess>(Error{scratch_.path() + " cannot be written: " + std::strerror(errno)});
    if (request.outputFd >= 0) close(request.outputFd);
    if (request.errorFd >= 0) close(request.errorFd);
    if (!child) return child.error();
    if (!awaitEnd(*child, Deadline::inMs(limitMs))) {
        endWithAll(*child, display_->pid(), kEndMs);
        return Error{name + " did not end within " + std::to_string(limitMs / 1000) + " s and was stopped"};
    }
    if (child->exitStatus() == 0) return textOf(output);
    const std::string why = lastLine(textOf(errors));
    return Error{name + ": " + (why.empty() ? child->describeEnd() : why)};
}

Result<std::string> AccuracyRuns::scenesProgram() {
    const std::string binary = launch::ownBinary();
    const std::string built = std::filesystem::path(binary).parent_path() / "mural-scenes";
    if (access(built.c_str(), X_OK) == 0) return built;
    const std::string installed = std::filesystem::path(libraryFolder(binary)) / "mural-scenes";
    if (access(installed.c_str(), X_OK) == 0) return installed;
    return Error{built + " is missing: build the target mural-scenes, or add a program after --"};
}

Result<std::vector<OwnedPicture>> readPictures(const std::string& folder) {
    std::vector<std::filesystem::path> paths;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) paths.push_back(entry.path());
    if (error) return Error{folder + " cannot be read: " + error.message()};
    std::ranges::sort(paths);
    std::vector<OwnedPicture> pictures;
    for (const auto& path : paths) {
        auto picture = path.extension() == ".ppm" ? readPpm(path) : readPng(path);
        if (!picture) return picture.error();
        pictures.push_back(std::move(*picture));
    }
    return pictures;
}

} // namespace mural::cli
