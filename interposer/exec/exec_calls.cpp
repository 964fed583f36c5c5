// Replaces the C library's calls that execute or start a program. Each call continues with an environment that keeps
// the new program captured. Calls of system() and popen() are not covered, because they start their shell inside the C
// library. Raw system calls are not covered either.
//
// The functions run after fork and vfork, so they allocate nothing and take no lock.
#include <cerrno>
#include <cstdarg>
#include <spawn.h>
#include <unistd.h>

#include "interposer/exec/captured_environment.hpp"
#include "interposer/loader/libc_loader.hpp"

namespace {

using mural::CapturedEnvironment;

struct Next {
    int (*execve)(const char*, char* const*, char* const*);
    int (*execvpe)(const char*, char* const*, char* const*);
    int (*fexecve)(int, char* const*, char* const*);
    int (*execveat)(int, const char*, char* const*, char* const*, int);
    int (*posixSpawn)(pid_t*, const char*, const posix_spawn_file_actions_t*, const posix_spawnattr_t*, char* const*,
                      char* const*);
    int (*posixSpawnp)(pid_t*, const char*, const posix_spawn_file_actions_t*, const posix_spawnattr_t*, char* const*,
                       char* const*);
};
Next next;

template <class F> void find(F& function, const char* name) {
    function = reinterpret_cast<F>(mural::loader::nextFunction(name));
}

// Runs at the start, because a forked child may find the loader's locks held.
__attribute__((constructor)) void findNext() {
    find(next.execve, "execve");
    find(next.execvpe, "execvpe");
    find(next.fexecve, "fexecve");
    find(next.execveat, "execveat");
    find(next.posixSpawn, "posix_spawn");
    find(next.posixSpawnp, "posix_spawnp");
}

const Next& nextCalls() {
    if (!next.execve) findNext(); // for calls from another library's constructor
    return next;
}

int notThere() {
    errno = ENOSYS;
    return -1;
}

} // namespace

// Allocates in the caller's frame: only the stack is safe to use here.
#define CAPTURED(environment)                                                                                          \
    const CapturedEnvironment change(environment);                                                                     \
    char* const* captured = environment;                                                                               \
    if (change.neededBytes()) captured = change.build(__builtin_alloca(change.neededBytes()))

// Collects the arguments of execl and its variants, from `first` to the terminating null.
#define LISTED(arguments, first)                                                                                       \
    va_list list;                                                                                                      \
    size_t count = 1;                                                                                                  \
    va_start(list, first);                                                                                             \
    while (va_arg(list, char*)) ++count;                                                                               \
    va_end(list);                                                                                                      \
    auto** arguments = static_cast<char**>(__builtin_alloca((count + 1) * sizeof(char*)));                             \
    arguments[0] = const_cast<char*>(first);                                                                           \
    va_start(list, first);                                                                                             \
    for (size_t i = 1; i <= count; ++i) (arguments)[i] = va_arg(list, char*)

#define MURAL_EXEC extern "C" __attribute__((visibility("default")))

MURAL_EXEC int execve(const char* path, char* const* arguments, char* const* environment) noexcept {
    CAPTURED(environment);
    return nextCalls().execve ? next.execve(path, arguments, captured) : notThere();
}

MURAL_EXEC int execv(const char* path, char* const* arguments) noexcept { return execve(path, arguments, environ); }

MURAL_EXEC int execvpe(const char* file, char* const* arguments, char* const* environment) noexcept {
    CAPTURED(environment);
    return nextCalls().execvpe ? next.execvpe(file, arguments, captured) : notThere();
}

MURAL_EXEC int execvp(const char* file, char* const* arguments) noexcept { return execvpe(file, arguments, environ); }

MURAL_EXEC int fexecve(int fd, char* const* arguments, char* const* environment) noexcept {
    CAPTURED(environment);
    return nextCalls().fexecve ? next.fexecve(fd, arguments, captured) : notThere();
}

MURAL_EXEC int execveat(int folder, const char* path, char* const* arguments, char* const* environment,
                        int flags) noexcept {
    CAPTURED(environment);
    return nextCalls().execveat ? next.execveat(folder, path, arguments, captured, flags) : notThere();
}

MURAL_EXEC int posix_spawn(pid_t* pid, const char* path, const posix_spawn_file_actions_t* actions,
                           const posix_spawnattr_t* attributes, char* const* arguments, char* const* environment) {
    CAPTURED(environment);
    return nextCalls().posixSpawn ? next.posixSpawn(pid, path, actions, attributes, arguments, captured) : ENOSYS;
}

MURAL_EXEC int posix_spawnp(pid_t* pid, const char* file, const posix_spawn_file_actions_t* actions,
                            const posix_spawnattr_t* attributes, char* const* arguments, char* const* environment) {
    CAPTURED(environment);
    return nextCalls().posixSpawnp ? next.posixSpawnp(pid, file, actions, attributes, arguments, captured) : ENOSYS;
}

MURAL_EXEC int execl(const char* path, const char* first, ...) noexcept {
    LISTED(arguments, first);
    va_end(list);
    return execve(path, arguments, environ);
}

MURAL_EXEC int execlp(const char* file, const char* first, ...) noexcept {
    LISTED(arguments, first);
    va_end(list);
    return execvpe(file, arguments, environ);
}

MURAL_EXEC int execle(const char* path, const char* first, ...) noexcept {
    LISTED(arguments, first);
    char* const* environment = va_arg(list, char* const*); // follows the null
    va_end(list);
    return execve(path, arguments, environment);
}
