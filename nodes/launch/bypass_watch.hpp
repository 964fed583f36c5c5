// By what programs draw when Mural sees nothing of it: from the libraries of their processes, and from
// what the library inside them leaves when they end. Owned by one thread.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/result.hpp"

namespace mural::launch {

// A program that Mural has seen no context of, and its libraries.
struct UnseenProgram {
    std::string program;
    std::vector<std::string> libraries; // paths
};

// One line about the programs: which one draws past Mural, by what, and what to do; empty when their
// libraries do not tell. Of one that failed, to have loaded no GL yet tells nothing.
std::string describeBypass(const std::vector<UnseenProgram>& programs, bool failed = false);

// The same about one that runs GL without the capture library; empty where it has the library, or no GL.
std::string describeUncaptured(const UnseenProgram& program);

class BypassWatch {
public:
    static Result<std::unique_ptr<BypassWatch>> create();
    BypassWatch(const BypassWatch&) = delete;
    BypassWatch& operator=(const BypassWatch&) = delete;
    ~BypassWatch();

    // The file for the captured programs' notes (MURAL_NOTES).
    [[nodiscard]] std::string notesPath() const;
    // Lines that captured programs want said, each once.
    std::vector<std::string> news();
    // Looks at processes that run now.
    [[nodiscard]] std::string lookAt(const std::vector<pid_t>& processes) const;
    // One line for each program that runs GL without the capture library, the first time it is seen; empty: there is none.
    std::string uncaptured(const std::vector<pid_t>& processes);
    // About the programs that have ended; failed: the one that was started, with an error.
    [[nodiscard]] std::string aboutEnded(bool failed) const { return describeBypass(ended_, failed); }

private:
    explicit BypassWatch(int fd) : fd_(fd) {}
    void readNotes();

    int fd_;
    size_t read_ = 0; // bytes of the notes
    std::vector<std::string> said_, waiting_;
    std::vector<UnseenProgram> ended_;
    std::set<std::string> saidUncaptured_; // their names
};

} // namespace mural::launch
