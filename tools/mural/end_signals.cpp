#include "tools/mural/end_signals.hpp"

#include <cerrno>
#include <csignal>
#include <sys/signalfd.h>

#include "nodes/launch/child_process.hpp"
#include "transport/system_error.hpp"

namespace mural::cli {

Result<FileDescriptor> endSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, number);
    launch::rememberSignals();
    if (pthread_sigmask(SIG_BLOCK, &signals, nullptr) != 0) return Error{"cannot wait for signals"};
    FileDescriptor fd(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
    if (!fd.valid()) return Error{"cannot create a signalfd: " + errnoText(errno)};
    return fd;
}

} // namespace mural::cli
