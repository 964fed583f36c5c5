#include "interposer/diagnostics/bypass.hpp"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <initializer_list>
#include <link.h>
#include <unistd.h>

#include "interposer/process/launch_settings.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/process/process.hpp"

namespace mural {

namespace {

int openFile(const char* path, int flags) {
    int fd = -1;
    do {
        fd = open(path, flags);
    } while (fd < 0 && errno == EINTR);
    return fd;
}

bool note(const char* text, size_t length) {
    const char* path = launchSettings().session ? launchSettings().notes : nullptr;
    const int fd = path ? openFile(path, O_WRONLY | O_APPEND | O_CLOEXEC) : -1;
    if (fd < 0) return false;
    const bool written = writeAll(fd, text, length);
    close(fd);
    return written;
}

// One note about this process: the program, and the loaded libraries with which it could have drawn.
struct Libraries {
    char text[8192];
    size_t length;
    bool any;

    bool add(const char* field) {
        const size_t bytes = std::strlen(field);
        if (length + bytes + 2 > sizeof text || std::strpbrk(field, "\t\n")) return false;
        std::memcpy(text + length, field, bytes);
        length += bytes;
        text[length++] = '\t';
        return true;
    }
};

int addLibrary(dl_phdr_info* info, size_t, void* into) {
    auto* libraries = static_cast<Libraries*>(into);
    const char* slash = info->dlpi_name ? std::strrchr(info->dlpi_name, '/') : nullptr;
    if (!slash) return 0;
    for (const char* beginning :
         {"libGL", "libEGL", "libOSMesa", "libvulkan", "libX11.", "libxcb.", "libmural_preload"}) {
        if (!std::strncmp(slash + 1, beginning, std::strlen(beginning)) && !std::strstr(slash, "libGLX_mural") &&
            libraries->add(info->dlpi_name))
            libraries->any = true;
    }
    return 0;
}

// A process that was never captured reports its loaded libraries at its end. `mural run` shows the report to the user
// if it captured no process at all.
__attribute__((destructor)) void reportLibraries() {
    if (!launchSettings().notes || process::everCaptured()) return;
    static Libraries libraries;
    libraries.add("ended");
    char program[1024];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = 0;
    if (!libraries.add(length > 0 ? program : "a program")) return;
    dl_iterate_phdr(addLibrary, &libraries);
    if (!libraries.any) return;
    libraries.text[libraries.length - 1] = '\n';
    note(libraries.text, libraries.length);
}

} // namespace

void reportBypass(const char* format, ...) {
    constexpr char kPrefix[] = "say\t";
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    const size_t length = formatLine(line, sizeof line, kPrefix, format, arguments);
    va_end(arguments);
    if (length == 0 || note(line, length)) return;
    line[length - 1] = 0;
    say("%s", line + sizeof kPrefix - 1);
}

} // namespace mural
