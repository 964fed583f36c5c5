// Ctrl-C, and what else asks `mural bench accuracy` to end: noticed by what waits, so that processes are ended and folders removed
// by who made them.
#pragma once

#include <array>
#include <csignal>

namespace mural::cli {

// As long as it lives, these signals are only noted. There is one at a time.
class Interruption {
public:
    Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    ~Interruption(); // they do again what they did before

    // The first that came since there was one; 0: none.
    static int signal();

private:
    // SIGPIPE: who reads what is said has gone. It ends most programs, and must leave nothing behind, either.
    static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    std::array<struct sigaction, kSignals.size()> before_{};
};

} // namespace mural::cli
