// A child process that is fed through its standard input: started, fed with a deadline, and ended
// for sure. It gets a process group of its own, so that Ctrl-C at the terminal does not end it
// before it has completed its file; if this process dies, it reads the end of its input and
// completes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"

namespace mural {

// Full path of a program in PATH (or `name` itself when it has a slash); empty when there is none.
std::string findProgram(const std::string& name);

class EncoderProcess {
public:
    // arguments[0] is the program as findProgram() gives it. What the child writes to standard
    // output is kept for output(), what it writes to standard error for its error messages.
    static Result<std::unique_ptr<EncoderProcess>> start(const std::vector<std::string>& arguments);

    EncoderProcess(const EncoderProcess&) = delete;
    EncoderProcess& operator=(const EncoderProcess&) = delete;
    ~EncoderProcess(); // kills a child that is still there

    // Fails when the child has ended or does not read for too long.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline);

    // Ends the child's input and waits for it. A child that is not done by the deadline is asked to
    // end (SIGTERM) and then killed; that, and an exit status other than 0, is an error.
    Result<void> finish(Deadline deadline);

    // What the child has written to its standard output so far.
    [[nodiscard]] std::string output() const;

    [[nodiscard]] pid_t pid() const { return pid_; } // -1 when it has ended

private:
    EncoderProcess() = default;

    bool ended(int64_t waitNs);
    Error howItEnded();
    void kill();

    std::string program_;
    pid_t pid_ = -1;
    int pidFd_ = -1;    // -1 where the kernel has none
    int inputFd_ = -1;  // our end of a socket pair
    int outputFd_ = -1; // memory files
    int errorFd_ = -1;
    int status_ = 0; // of waitpid, once the child has ended
};

} // namespace mural
