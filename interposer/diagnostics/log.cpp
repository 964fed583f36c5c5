#include "interposer/diagnostics/log.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mural {

namespace {

struct FileIdentity {
    bool isOpen;
    dev_t device;
    ino_t inode;
};

FileIdentity identityOf(int fd) {
    struct stat file {};
    if (fstat(fd, &file) != 0) return {false, 0, 0};
    return {true, file.st_dev, file.st_ino};
}

FileIdentity userStderr{};
__attribute__((constructor)) void rememberStderr() { userStderr = identityOf(STDERR_FILENO); }

bool isUserStderr() {
    const FileIdentity now = identityOf(STDERR_FILENO);
    return now.isOpen && userStderr.isOpen && now.device == userStderr.device && now.inode == userStderr.inode;
}

// Suppresses the signals of failed writes: SIGPIPE for a closed pipe, SIGXFSZ for a file-size limit. Both go to the
// writing thread. The destructor removes them.
class NoWriteSignals {
public:
    NoWriteSignals() {
        sigemptyset(&signals_);
        sigset_t pending;
        sigpending(&pending);
        for (const int number : {SIGPIPE, SIGXFSZ})
            if (!sigismember(&pending, number)) sigaddset(&signals_, number); // pending signals are the program's own
        pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    }
    ~NoWriteSignals() {
        const timespec now{};
        const int error = errno;
        while (sigtimedwait(&signals_, nullptr, &now) > 0) {}
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
        errno = error;
    }
    NoWriteSignals(const NoWriteSignals&) = delete;
    NoWriteSignals& operator=(const NoWriteSignals&) = delete;

private:
    sigset_t signals_{}, before_{};
};

} // namespace

bool writeAll(int fd, const void* data, size_t bytes) {
    const NoWriteSignals quiet;
    const auto* at = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t n = write(fd, at, bytes);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        at += n;
        bytes -= static_cast<size_t>(n);
    }
    return true;
}

size_t formatLine(char* line, size_t sizeBytes, const char* prefix, const char* format, va_list arguments) {
    const size_t before = std::strlen(prefix);
    if (before + 2 > sizeBytes) return 0;
    std::memcpy(line, prefix, before);
    const int n = vsnprintf(line + before, sizeBytes - before, format, arguments);
    if (n < 0) return 0;
    const size_t whole = before + static_cast<size_t>(n);
    const size_t end = whole < sizeBytes ? whole : sizeBytes - 1; // the newline replaces vsnprintf's terminator
    line[end] = '\n';
    return end + 1;
}

void say(const char* format, ...) {
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    const size_t length = formatLine(line, sizeof line, "mural: ", format, arguments);
    va_end(arguments);
    if (isUserStderr()) writeAll(STDERR_FILENO, line, length);
}

} // namespace mural
