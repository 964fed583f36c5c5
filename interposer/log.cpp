#include "interposer/log.hpp"

#include <cstdio>
#include <cstring>
#include <unistd.h>

namespace mural {

size_t formatLine(char* line, size_t sizeBytes, const char* prefix, const char* format, va_list arguments) {
    const size_t before = std::strlen(prefix);
    if (before + 2 > sizeBytes) return 0;
    std::memcpy(line, prefix, before);
    const int n = vsnprintf(line + before, sizeBytes - before, format, arguments);
    if (n < 0) return 0;
    const size_t whole = before + static_cast<size_t>(n);
    const size_t end = whole < sizeBytes ? whole : sizeBytes - 1; // vsnprintf has kept one byte, which the newline takes
    line[end] = '\n';
    return end + 1;
}

void say(const char* format, ...) {
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    const size_t length = formatLine(line, sizeof line, "mural: ", format, arguments);
    va_end(arguments);
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line, length);
}

} // namespace mural
