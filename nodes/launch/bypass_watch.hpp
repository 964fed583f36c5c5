// Determines how programs draw if none of their GL calls is captured. Examines the libraries of their processes, and
// the notes that the capture library writes when a program ends. Owned by one thread.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/result.hpp"

namespace mural::launch {

// A program without a captured context, and its libraries.
struct UncapturedProgram {
    std::string program;
    std::vector<std::string> libraries; // paths
};

// Returns one line: the program that draws without the capture library, its method, and the remedy. Empty: the
// libraries show nothing. failed: the program ended with an error, so a missing GL library proves nothing.
std::string describeBypass(const std::vector<UncapturedProgram>& programs, bool failed = false);

// Returns a line about a program that uses GL without the capture library. Empty: the program has the library, or no
// GL.
std::string describeUncaptured(const UncapturedProgram& program);

class BypassWatch {
public:
    static Result<std::unique_ptr<BypassWatch>> create();
    BypassWatch(const BypassWatch&) = delete;
    BypassWatch& operator=(const BypassWatch&) = delete;
    ~BypassWatch();

    // The file for the captured programs' notes (MURAL_NOTES).
    [[nodiscard]] std::string notesPath() const;
    // Returns new lines from the notes of captured programs, each once.
    std::vector<std::string> newLines();
    // Examines running processes. Returns a line as describeBypass().
    [[nodiscard]] std::string describeRunning(const std::vector<pid_t>& processes) const;
    // Returns one line for each program that uses GL without the capture library, at its first detection. Empty: none.
    std::string describeUncaptured(const std::vector<pid_t>& processes);
    // Returns a line about programs that have ended. failed: the started program ended with an error.
    [[nodiscard]] std::string describeEnded(bool failed) const { return describeBypass(ended_, failed); }

private:
    explicit BypassWatch(int fd) : fd_(fd) {}
    void readNotes();

    int fd_;
    size_t read_ = 0; // bytes of the notes
    std::vector<std::string> reported_, waiting_;
    std::vector<UncapturedProgram> ended_;
    std::set<std::string> uncapturedReported_; // their names
};

} // namespace mural::launch
