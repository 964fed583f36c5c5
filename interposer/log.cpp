#include "interposer/log.hpp"

#include <cstdarg>
#include <cstdio>
#include <unistd.h>

namespace mural {

void say(const char* format, ...) {
    char line[1024] = "mural: ";
    constexpr int kPrefix = 7;
    va_list arguments;
    va_start(arguments, format);
    int n = vsnprintf(line + kPrefix, sizeof line - kPrefix - 1, format, arguments);
    va_end(arguments);
    if (n < 0) return;
    n += kPrefix;
    if (n > static_cast<int>(sizeof line) - 2) n = sizeof line - 2;
    line[n++] = '\n';
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line, static_cast<size_t>(n));
}

} // namespace mural
