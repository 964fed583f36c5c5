/* Saves the contents of a program's windows: a library for LD_PRELOAD that reads the window through X
 * immediately after each swap, as a screenshot function of the program would.
 *
 *   GRAB_OUT=folder   a sub-folder per window (w0, w1, … in the order of their first swaps) with one PPM
 *                     per frame (f0000.ppm …); without it the library does nothing
 *   GRAB_FLUSH=1      glFlush and glFinish show a frame, too: for windows with a single buffer
 *   GRAB_READ=copy    reads by XCopyArea into a pixmap instead of XGetImage of the window
 * Only for programs that are linked to their GL library: dlsym and GetProcAddress are not hooked (grab.c hooks them).
 */
#define _GNU_SOURCE
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define EXPORT __attribute__((visibility("default")))

enum { MAX_WINDOWS = 256 };

static void* nextSymbol(const char* name) {
    /* No tail call: with one, glibc would resolve RTLD_NEXT from the caller's position in the link order. */
    void* volatile found = dlsym(RTLD_NEXT, name);
    if (found == NULL) {
        fprintf(stderr, "window_grab: the program has no %s\n", name);
        abort();
    }
    return found;
}

/* The next function `name`, with the type that the headers or this file declare. */
#define NEXT(name) ((__typeof__(&name))nextSymbol(#name))

/* ---- pictures --------------------------------------------------------------------------------- */

static pthread_mutex_t windowsLock = PTHREAD_MUTEX_INITIALIZER;
static struct {
    Window id;
    int frames;
} windows[MAX_WINDOWS];
static int windowCount;

static FILE* nextPicture(Window window) {
    int number = 0;
    while (number < windowCount && windows[number].id != window) {
        ++number;
    }
    if (number == MAX_WINDOWS) {
        return NULL;
    }
    char path[1100];
    snprintf(path, sizeof path, "%s/w%d", getenv("GRAB_OUT"), number);
    if (number == windowCount) {
        windows[windowCount++].id = window;
        mkdir(path, 0777);
    }
    snprintf(path, sizeof path, "%s/w%d/f%04d.ppm", getenv("GRAB_OUT"), number, windows[number].frames++);
    return fopen(path, "wb");
}

static XImage* readWindow(Display* display, Window window, const XWindowAttributes* a) {
    const unsigned width = (unsigned)a->width;
    const unsigned height = (unsigned)a->height;
    const char* way = getenv("GRAB_READ");
    if (way == NULL || strcmp(way, "copy") != 0) {
        return NEXT(XGetImage)(display, window, 0, 0, width, height, AllPlanes, ZPixmap);
    }
    const Pixmap pixmap = NEXT(XCreatePixmap)(display, window, width, height, (unsigned)a->depth);
    GC gc = NEXT(XCreateGC)(display, window, 0, NULL);
    NEXT(XCopyArea)(display, window, pixmap, gc, 0, 0, width, height, 0, 0);
    XImage* image = NEXT(XGetImage)(display, pixmap, 0, 0, width, height, AllPlanes, ZPixmap);
    NEXT(XFreeGC)(display, gc);
    NEXT(XFreePixmap)(display, pixmap);
    return image;
}

static void writeImage(FILE* file, const XImage* image) {
    fprintf(file, "P6\n%d %d\n255\n", image->width, image->height);
    for (int y = 0; y < image->height; ++y) {
        for (int x = 0; x < image->width; ++x) {
            const char* bgrx = image->data + (size_t)y * (size_t)image->bytes_per_line + (size_t)x * 4;
            const char rgb[3] = {bgrx[2], bgrx[1], bgrx[0]};
            fwrite(rgb, 1, 3, file);
        }
    }
}

static void grabWindow(Display* display, Window window) {
    XWindowAttributes attributes;
    if (getenv("GRAB_OUT") == NULL || display == NULL || window == 0 ||
        !NEXT(XGetWindowAttributes)(display, window, &attributes)) {
        return;
    }
    pthread_mutex_lock(&windowsLock);
    XImage* image = readWindow(display, window, &attributes);
    FILE* file = nextPicture(window);
    if (image == NULL || file == NULL || image->bits_per_pixel != 32) {
        fprintf(stderr, "window_grab: can't read or write the picture of window 0x%lx\n", window);
    } else {
        writeImage(file, image);
    }
    if (file != NULL) {
        fclose(file);
    }
    if (image != NULL) {
        XDestroyImage(image);
    }
    pthread_mutex_unlock(&windowsLock);
}

/* ---- GLX -------------------------------------------------------------------------------------- */

EXPORT void glXSwapBuffers(Display* display, unsigned long drawable) {
    NEXT(glXSwapBuffers)(display, drawable);
    grabWindow(display, drawable);
}

static void grabFlushed(void) {
    const char* value = getenv("GRAB_FLUSH");
    if (value == NULL || value[0] != '1') {
        return;
    }
    Display* display = ((Display * (*)(void)) nextSymbol("glXGetCurrentDisplay"))();
    grabWindow(display, ((Window(*)(void))nextSymbol("glXGetCurrentDrawable"))());
}

EXPORT void glFlush(void) {
    NEXT(glFlush)();
    grabFlushed();
}

EXPORT void glFinish(void) {
    NEXT(glFinish)();
    grabFlushed();
}

/* ---- EGL -------------------------------------------------------------------------------------- */

static Display* eglNative;
static struct {
    void* surface;
    Window window;
} surfaces[MAX_WINDOWS];
static int surfaceCount;

EXPORT void* eglGetDisplay(Display* native) {
    eglNative = native;
    return NEXT(eglGetDisplay)(native);
}

EXPORT void* eglCreateWindowSurface(void* display, void* config, Window window, const int32_t* attributes) {
    void* surface = NEXT(eglCreateWindowSurface)(display, config, window, attributes);
    if (surface != NULL && surfaceCount < MAX_WINDOWS) {
        surfaces[surfaceCount].surface = surface;
        surfaces[surfaceCount++].window = window;
    }
    return surface;
}

EXPORT unsigned eglSwapBuffers(void* display, void* surface) {
    const unsigned done = NEXT(eglSwapBuffers)(display, surface);
    for (int i = surfaceCount; i-- > 0;) {
        if (surfaces[i].surface == surface) {
            grabWindow(eglNative, surfaces[i].window);
            break;
        }
    }
    return done;
}
