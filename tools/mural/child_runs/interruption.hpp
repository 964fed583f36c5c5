// Handles Ctrl-C and other termination signals of commands that run programs. Waiting code polls for them, so the
// owners of processes and folders clean up.
#pragma once

#include <array>
#include <csignal>

namespace mural::cli {

// While it exists, these signals are only recorded. Only one instance at a time.
class Interruption {
public:
    Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    ~Interruption(); // restores the previous handlers

    // Returns the first signal received; 0: none.
    static int signal();

private:
    // SIGPIPE: the reader of the output has gone. It would end the process without clean-up.
    static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    std::array<struct sigaction, kSignals.size()> before_{};
};

} // namespace mural::cli
