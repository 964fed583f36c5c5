// A child process that receives data from this process on its standard input, with deadlines for its start, its input
// and its end. It has its own process group, so that Ctrl-C does not end it before its file is complete. If this
// process dies, the child reads end-of-file and completes the file.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

// The full path of a program in PATH, or `name` itself if it has a slash; empty: not found.
std::string findProgram(const std::string& name);

class EncoderProcess {
public:
    // arguments[0] is a result of findProgram(). Standard output is kept for output(), standard error for error
    // messages.
    static Result<std::unique_ptr<EncoderProcess>> start(const std::vector<std::string>& arguments);

    EncoderProcess(const EncoderProcess&) = delete;
    EncoderProcess& operator=(const EncoderProcess&) = delete;
    ~EncoderProcess(); // kills a running child

    // Errors: the child has ended, or does not read before the deadline.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline);

    // Closes the child's input and waits for its end. After the deadline the child receives SIGTERM, then SIGKILL.
    // That, and an exit status other than 0, is an error.
    Result<void> finish(Deadline deadline);

    // The child's standard output so far.
    [[nodiscard]] std::string output() const;

    [[nodiscard]] pid_t pid() const { return pid_; } // -1 after its end

private:
    EncoderProcess() = default;

    bool ended(int64_t waitNs);
    Error howItEnded();
    void kill();

    std::string program_;
    pid_t pid_ = -1;
    int pidFd_ = -1;    // -1 without kernel support
    int inputFd_ = -1;  // this process's end of a socket pair
    int outputFd_ = -1; // memfds
    int errorFd_ = -1;
    int status_ = 0; // of waitpid, after the child has ended
};

} // namespace mural
