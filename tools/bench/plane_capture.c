/* Preloaded into a GL program: writes colour and depth of chosen frames as they stand before the swap, then ends the
 * program. What tools/bench/compositing measures codecs on.
 *
 *   PLANE_CAPTURE_OUT=PREFIX   files PREFIX.RGBA8.plane, PREFIX.D24S8.plane, PREFIX.D32F.plane: one line
 *                              "plane FORMAT WIDTH HEIGHT", then the rows, lowest first
 *   PLANE_CAPTURE_FRAME=N      the swap before which they are written (from 1; default 10)
 *   PLANE_CAPTURE_NEXT=1       writes frame N+1 as PREFIX.next.… too
 *
 * Programs find glXSwapBuffers by linking, by dlsym, or by glXGetProcAddress, and EGL's likewise: all ways are caught.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))

enum {
    kViewport = 0x0BA2,
    kRgba = 0x1908,
    kUnsignedByte = 0x1401,
    kDepthStencil = 0x84F9,
    kUnsignedInt248 = 0x84FA,
    kDepth = 0x1902,
    kFloat = 0x1406,
    kPackAlignment = 0x0D05,
    kPackRowLength = 0x0D02,
    kPackBuffer = 0x88EB,
    kPackBufferBinding = 0x88ED,
    kReadFramebuffer = 0x8CA8,
    kReadFramebufferBinding = 0x8CAA
};

typedef void (*function)(void);
typedef void* (*dlsym_function)(void*, const char*);
typedef function (*get_proc_function)(const char*);
typedef void (*swap_function)(void*, uintptr_t);
typedef unsigned (*egl_swap_function)(void*, void*);

static dlsym_function real_dlsym(void) {
    static dlsym_function found;
    if (!found) found = (dlsym_function)dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.34");
    if (!found) found = (dlsym_function)dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    return found;
}

static void* real(const char* library, const char* name) {
    void* found = real_dlsym()(RTLD_NEXT, name);
    if (found) return found;
    void* handle = dlopen(library, RTLD_LAZY | RTLD_GLOBAL);
    return handle ? real_dlsym()(handle, name) : NULL;
}

static void* gl(const char* name) { return real("libGL.so.1", name); }

static void write_plane(const char* prefix, const char* format, int width, int height, const void* pixels) {
    char path[4096];
    snprintf(path, sizeof path, "%s.%s.plane", prefix, format);
    FILE* file = fopen(path, "wb");
    if (!file) {
        fprintf(stderr, "plane_capture: cannot write %s; check PLANE_CAPTURE_OUT\n", path);
        return;
    }
    fprintf(file, "plane %s %d %d\n", format, width, height);
    if (fwrite(pixels, 4, (size_t)width * (size_t)height, file) != (size_t)width * (size_t)height)
        fprintf(stderr, "plane_capture: %s is cut short; is the disk full?\n", path);
    fclose(file);
}

static void read_planes(const char* prefix) {
    void (*get)(unsigned, int*) = (void (*)(unsigned, int*))gl("glGetIntegerv");
    void (*store)(unsigned, int) = (void (*)(unsigned, int))gl("glPixelStorei");
    void (*read_pixels)(int, int, int, int, unsigned, unsigned, void*) =
        (void (*)(int, int, int, int, unsigned, unsigned, void*))gl("glReadPixels");
    void (*bind_buffer)(unsigned, unsigned) = (void (*)(unsigned, unsigned))gl("glBindBuffer");
    void (*bind_framebuffer)(unsigned, unsigned) = (void (*)(unsigned, unsigned))gl("glBindFramebuffer");
    if (!get || !store || !read_pixels) {
        fprintf(stderr, "plane_capture: this program has no OpenGL to read from\n");
        return;
    }
    int viewport[4] = {0}, alignment = 4, row_length = 0, buffer = 0, framebuffer = 0;
    get(kViewport, viewport);
    get(kPackAlignment, &alignment);
    get(kPackRowLength, &row_length);
    if (bind_buffer) get(kPackBufferBinding, &buffer);
    if (bind_framebuffer) get(kReadFramebufferBinding, &framebuffer);
    const int width = viewport[0] + viewport[2], height = viewport[1] + viewport[3];
    void* pixels = calloc((size_t)width * (size_t)height, 4);
    if (!pixels) return;
    store(kPackAlignment, 1);
    store(kPackRowLength, 0);
    if (buffer) bind_buffer(kPackBuffer, 0);
    if (framebuffer) bind_framebuffer(kReadFramebuffer, 0);
    read_pixels(0, 0, width, height, kRgba, kUnsignedByte, pixels);
    write_plane(prefix, "RGBA8", width, height, pixels);
    read_pixels(0, 0, width, height, kDepthStencil, kUnsignedInt248, pixels);
    write_plane(prefix, "D24S8", width, height, pixels);
    read_pixels(0, 0, width, height, kDepth, kFloat, pixels);
    write_plane(prefix, "D32F", width, height, pixels);
    store(kPackAlignment, alignment);
    store(kPackRowLength, row_length);
    if (buffer) bind_buffer(kPackBuffer, (unsigned)buffer);
    if (framebuffer) bind_framebuffer(kReadFramebuffer, (unsigned)framebuffer);
    free(pixels);
}

static void before_swap(void) {
    static int swaps;
    const char* out = getenv("PLANE_CAPTURE_OUT");
    const char* wanted = getenv("PLANE_CAPTURE_FRAME");
    const int frame = wanted ? atoi(wanted) : 10;
    const int next = getenv("PLANE_CAPTURE_NEXT") != NULL;
    ++swaps;
    if (!out || swaps < frame) return;
    if (swaps == frame) read_planes(out);
    if (next && swaps == frame + 1) {
        char prefix[4000];
        snprintf(prefix, sizeof prefix, "%s.next", out);
        read_planes(prefix);
    }
    if (swaps >= frame + next) _exit(0);
}

EXPORT void glXSwapBuffers(void* display, uintptr_t drawable) {
    before_swap();
    swap_function swap = (swap_function)gl("glXSwapBuffers");
    if (swap) swap(display, drawable);
}

EXPORT unsigned eglSwapBuffers(void* display, void* surface) {
    before_swap();
    egl_swap_function swap = (egl_swap_function)real("libEGL.so.1", "eglSwapBuffers");
    return swap ? swap(display, surface) : 0;
}

EXPORT function glXGetProcAddressARB(const char* name);
EXPORT function glXGetProcAddress(const char* name);
EXPORT function eglGetProcAddress(const char* name);

static function replacementOf(const char* name) {
    if (strcmp(name, "glXSwapBuffers") == 0) return (function)glXSwapBuffers;
    if (strcmp(name, "eglSwapBuffers") == 0) return (function)eglSwapBuffers;
    if (strcmp(name, "glXGetProcAddressARB") == 0) return (function)glXGetProcAddressARB;
    if (strcmp(name, "glXGetProcAddress") == 0) return (function)glXGetProcAddress;
    if (strcmp(name, "eglGetProcAddress") == 0) return (function)eglGetProcAddress;
    return NULL;
}

static function found_by(const char* library, const char* finder, const char* name) {
    function own = replacementOf(name);
    get_proc_function find = (get_proc_function)real(library, finder);
    return own ? own : find ? find(name) : NULL;
}

function glXGetProcAddressARB(const char* name) { return found_by("libGL.so.1", "glXGetProcAddressARB", name); }
function glXGetProcAddress(const char* name) { return found_by("libGL.so.1", "glXGetProcAddress", name); }
function eglGetProcAddress(const char* name) { return found_by("libEGL.so.1", "eglGetProcAddress", name); }

EXPORT void* dlsym(void* handle, const char* name) {
    function own = replacementOf(name);
    void* original = real_dlsym()(handle, name);
    return own && original ? (void*)own : original;
}
