/* Simulates the overlay of a game launcher or screen recorder: a preloaded library that hooks swaps, XGetImage, dlsym,
 * dlopen and dlclose. It finds the next function with RTLD_NEXT, from its own position in the link order. At the end it
 * prints the calls that it has seen. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))

typedef void* (*dlsym_function)(void*, const char*);
typedef void* (*dlopen_function)(const char*, int);
typedef int (*dlclose_function)(void*);
typedef void (*gl_function)(void);

static int swaps, lookups, reads;

static void* of_libc(const char* name) {
    void* volatile found = dlvsym(RTLD_NEXT, name, "GLIBC_2.34");
    if (!found) found = dlvsym(RTLD_NEXT, name, "GLIBC_2.17");
    if (!found) found = dlvsym(RTLD_NEXT, name, "GLIBC_2.2.5");
    return found;
}

/* Returns the next function of this name. The result is not cached, because its library may be unloaded and reloaded.
 */
static void* next_of(const char* name) {
    const dlsym_function next = (dlsym_function)of_libc("dlsym");
    const dlopen_function open_next = (dlopen_function)of_libc("dlopen");
    static const char* const libraries[] = {"libGL.so.1", "libEGL.so.1", "libX11.so.6"};
    void* volatile found = next(RTLD_NEXT, name);
    for (int i = 0; !found && i < 3; ++i) {
        void* handle = open_next(libraries[i], RTLD_LAZY | RTLD_NOLOAD);
        if (!handle) continue;
        found = next(handle, name);
        ((dlclose_function)of_libc("dlclose"))(handle);
    }
    return found;
}

EXPORT void glXSwapBuffers(void* display, unsigned long window) {
    ++swaps;
    ((void (*)(void*, unsigned long))next_of("glXSwapBuffers"))(display, window);
}

EXPORT unsigned eglSwapBuffers(void* display, void* surface) {
    ++swaps;
    return ((unsigned (*)(void*, void*))next_of("eglSwapBuffers"))(display, surface);
}

EXPORT void* XGetImage(void* display, unsigned long d, int x, int y, unsigned w, unsigned h, unsigned long planes,
                       int format) {
    ++reads;
    return ((void* (*)(void*, unsigned long, int, int, unsigned, unsigned, unsigned long, int))next_of("XGetImage"))(
        display, d, x, y, w, h, planes, format);
}

static void* own(const char* name) {
    if (!strcmp(name, "glXSwapBuffers")) return (void*)glXSwapBuffers;
    if (!strcmp(name, "eglSwapBuffers")) return (void*)eglSwapBuffers;
    if (!strcmp(name, "XGetImage")) return (void*)XGetImage;
    return NULL;
}

EXPORT gl_function glXGetProcAddressARB(const unsigned char* name) {
    void* found = own((const char*)name);
    return found ? (gl_function)found : ((gl_function(*)(const unsigned char*))next_of("glXGetProcAddressARB"))(name);
}

EXPORT gl_function glXGetProcAddress(const unsigned char* name) { return glXGetProcAddressARB(name); }

EXPORT gl_function eglGetProcAddress(const char* name) {
    void* found = own(name);
    return found ? (gl_function)found : ((gl_function(*)(const char*))next_of("eglGetProcAddress"))(name);
}

/* RTLD_NEXT from the program is not handled: the lookup starts after this library. */
EXPORT void* dlsym(void* handle, const char* name) {
    ++lookups;
    void* found = own(name);
    void* volatile next = found ? found : ((dlsym_function)of_libc("dlsym"))(handle, name);
    return next;
}

EXPORT void* dlopen(const char* name, int flags) {
    void* volatile handle = ((dlopen_function)of_libc("dlopen"))(name, flags);
    return handle;
}

EXPORT int dlclose(void* handle) { return ((dlclose_function)of_libc("dlclose"))(handle); }

__attribute__((destructor)) static void reportCalls(void) {
    char line[96];
    const int length =
        snprintf(line, sizeof line, "the overlay saw %d swaps, %s\n", swaps, lookups ? "lookups" : "no lookups");
    if (swaps && write(STDOUT_FILENO, line, (size_t)length) < 0) _exit(3);
}
