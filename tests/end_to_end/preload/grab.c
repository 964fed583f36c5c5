/* Saves the pictures that a program shows: a library for LD_PRELOAD that reads the back buffer before every swap.
 *
 * It precedes all other preloaded libraries and reads through them, as the program itself would.
 *   GRAB_OUT=folder   a sub-folder per drawable (w0, w1, … in the order of their first swaps) with one
 *                     PPM per frame (f0000.ppm …); without it the library does nothing
 *   GRAB_FLUSH=1      glFlush and glFinish show a frame, too: for windows with a single buffer
 * It saves and restores the GL state that reading changes. A GL error of the program stays pending.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define EXPORT __attribute__((visibility("default")))

typedef void (*Function)(void);
typedef void* (*DlsymFunction)(void*, const char*);
typedef Function (*LookUpFunction)(const char*);

enum { MAX_DRAWABLES = 256 };

enum {
    GL_FRONT_BUFFER = 0x0404,
    GL_BACK_BUFFER = 0x0405,
    GL_BYTES = 0x1401,
    GL_RGBA_FORMAT = 0x1908,
    GL_VERSION_STRING = 0x1F02,
    GL_IS_DOUBLEBUFFERED = 0x0C32,
    GL_READ_BUFFER_NAME = 0x0C02,
    GL_READ_FRAMEBUFFER_TARGET = 0x8CA8,
    GL_READ_FRAMEBUFFER_NAME = 0x8CAA,
    GL_FRAMEBUFFER_TARGET = 0x8D40,
    GL_FRAMEBUFFER_NAME = 0x8CA6,
    GL_PACK_BUFFER_TARGET = 0x88EB,
    GL_PACK_BUFFER_NAME = 0x88ED,
    GL_PROFILE_MASK = 0x9126,
};

/* ---- the next library's functions ------------------------------------------------------------- */

enum Hook {
    GLX_SWAP,
    GLX_PROC,
    GLX_PROC_ARB,
    EGL_SWAP,
    EGL_SWAP_DAMAGE_KHR,
    EGL_SWAP_DAMAGE_EXT,
    EGL_PROC,
    GL_FLUSH,
    GL_FINISH,
    HOOK_COUNT
};

static const char* const hookNames[HOOK_COUNT] = {
    "glXSwapBuffers",
    "glXGetProcAddress",
    "glXGetProcAddressARB",
    "eglSwapBuffers",
    "eglSwapBuffersWithDamageKHR",
    "eglSwapBuffersWithDamageEXT",
    "eglGetProcAddress",
    "glFlush",
    "glFinish",
};

static Function nextOf[HOOK_COUNT]; /* functions that the program found using dlsym or GetProcAddress */
static DlsymFunction nextDlsym;
static Function replacementOf(enum Hook hook);

static int flushShows(void) {
    const char* value = getenv("GRAB_FLUSH");
    return value != NULL && value[0] == '1';
}

static void findNextDlsym(void) {
    static const char* const versions[] = {"GLIBC_2.34", "GLIBC_2.17", "GLIBC_2.2.5"};
    for (unsigned i = 0; nextDlsym == NULL && i < sizeof versions / sizeof *versions; ++i) {
        nextDlsym = (DlsymFunction)dlvsym(RTLD_NEXT, "dlsym", versions[i]);
    }
}

static void* symbolAfterUs(const char* name) {
    if (nextDlsym == NULL) {
        findNextDlsym();
    }
    /* No tail call: with one, glibc would resolve RTLD_NEXT from the caller's position in the link order. */
    void* volatile found = nextDlsym(RTLD_NEXT, name);
    static const char* const libraries[] = {"libGL.so.1", "libGLX.so.0", "libEGL.so.1"};
    for (unsigned i = 0; found == NULL && i < sizeof libraries / sizeof *libraries; ++i) {
        void* library = dlopen(libraries[i], RTLD_LAZY | RTLD_NOLOAD);
        if (library != NULL) {
            found = nextDlsym(library, name);
            dlclose(library);
        }
    }
    return found;
}

static Function next(enum Hook hook) {
    if (nextOf[hook] == NULL) {
        nextOf[hook] = (Function)symbolAfterUs(hookNames[hook]);
    }
    return nextOf[hook];
}

/* Returns the replacement for a name and stores `real`. NULL: the name is not hooked. */
static Function replace(const char* name, Function real) {
    if (name == NULL || real == NULL || (name[0] != 'g' && name[0] != 'e')) {
        return NULL;
    }
    for (int hook = 0; hook < HOOK_COUNT; ++hook) {
        if (strcmp(name, hookNames[hook]) == 0) {
            if ((hook == GL_FLUSH || hook == GL_FINISH) && !flushShows()) {
                return NULL;
            }
            const Function replacement = replacementOf((enum Hook)hook);
            if (real != replacement && nextOf[hook] == NULL) {
                nextOf[hook] = real;
            }
            return replacement;
        }
    }
    return NULL;
}

/* GL's own libraries, and layers after this one, need the real functions instead of the hooks. */
static int belongsToGl(const void* address) {
    static const char* const prefixes[] = {"libGL", "libEGL", "libOpenGL", "libmural"};
    Dl_info info;
    if (dladdr(address, &info) == 0 || info.dli_fname == NULL) {
        return 0;
    }
    const char* slash = strrchr(info.dli_fname, '/');
    const char* name = slash != NULL ? slash + 1 : info.dli_fname;
    for (unsigned i = 0; i < sizeof prefixes / sizeof *prefixes; ++i) {
        if (strncmp(name, prefixes[i], strlen(prefixes[i])) == 0) {
            return 1;
        }
    }
    return 0;
}

EXPORT void* dlsym(void* handle, const char* name) {
    if (nextDlsym == NULL) {
        findNextDlsym();
    }
    if (handle != RTLD_NEXT && !belongsToGl(__builtin_return_address(0))) {
        const Function replacement = replace(name, (Function)nextDlsym(handle, name));
        if (replacement != NULL) {
            return (void*)replacement;
        }
    }
    /* A jump (this file is always built with -foptimize-sibling-calls): the next dlsym has to see
     * our caller, since RTLD_NEXT means "after the caller". */
    return nextDlsym(handle, name);
}

/* ---- reading ---------------------------------------------------------------------------------- */

struct Gl {
    void (*getIntegerv)(unsigned, int*);
    void (*getFloatv)(unsigned, float*);
    const unsigned char* (*getString)(unsigned);
    void (*pixelStorei)(unsigned, int);
    void (*pixelTransferf)(unsigned, float);
    void (*readBuffer)(unsigned);
    void (*readPixels)(int, int, int, int, unsigned, unsigned, void*);
    void (*bindFramebuffer)(unsigned, unsigned);
    void (*bindBuffer)(unsigned, unsigned);
};

static struct Gl loadGl(LookUpFunction lookUp) {
    struct Gl gl;
    gl.getIntegerv = (void (*)(unsigned, int*))lookUp("glGetIntegerv");
    gl.getFloatv = (void (*)(unsigned, float*))lookUp("glGetFloatv");
    gl.getString = (const unsigned char* (*)(unsigned))lookUp("glGetString");
    gl.pixelStorei = (void (*)(unsigned, int))lookUp("glPixelStorei");
    gl.pixelTransferf = (void (*)(unsigned, float))lookUp("glPixelTransferf");
    gl.readBuffer = (void (*)(unsigned))lookUp("glReadBuffer");
    gl.readPixels = (void (*)(int, int, int, int, unsigned, unsigned, void*))lookUp("glReadPixels");
    gl.bindFramebuffer = (void (*)(unsigned, unsigned))lookUp("glBindFramebuffer");
    gl.bindBuffer = (void (*)(unsigned, unsigned))lookUp("glBindBuffer");
    return gl;
}

/* Version of the current context. Queries that the version lacks would leave a GL error. */
struct Abilities {
    int es, version; /* 33 is 3.3 */
    int compatibility;
};

static struct Abilities abilitiesOf(const struct Gl* gl) {
    struct Abilities can = {0, 0, 0};
    const char* text = (const char*)gl->getString(GL_VERSION_STRING);
    if (text == NULL) {
        return can;
    }
    can.es = strncmp(text, "OpenGL ES", 9) == 0;
    while (*text != '\0' && (*text < '0' || *text > '9')) {
        ++text;
    }
    int major = 0;
    int minor = 0;
    if (sscanf(text, "%d.%d", &major, &minor) == 2) {
        can.version = major * 10 + minor;
    }
    can.compatibility = !can.es;
    if (!can.es && can.version >= 32) {
        int mask = 0;
        gl->getIntegerv(GL_PROFILE_MASK, &mask);
        can.compatibility = (mask & 1) == 0;
    } else if (!can.es && can.version == 31) {
        can.compatibility = 0;
    }
    return can;
}

struct Parameter {
    unsigned name;
    float neutral;
};

static const struct Parameter packParameters[] = {
    {0x0D05, 1}, /* alignment */
    {0x0D00, 0}, /* swap bytes; this and the next are desktop only */
    {0x0D01, 0}, /* least significant bit first */
    {0x0D02, 0}, /* row length */
    {0x0D03, 0}, /* skip rows */
    {0x0D04, 0}, /* skip pixels */
};

static const struct Parameter transferParameters[] = {
    {0x0D10, 0},              /* map colour */
    {0x0D14, 1}, {0x0D15, 0}, /* red scale, bias, and so on */
    {0x0D18, 1}, {0x0D19, 0}, {0x0D1A, 1}, {0x0D1B, 0}, {0x0D1C, 1}, {0x0D1D, 0},
};

enum { PACK_COUNT = 6, TRANSFER_COUNT = 9 };

struct Saved {
    int pack[PACK_COUNT];
    float transfer[TRANSFER_COUNT];
    int framebuffer, packBuffer, readBuffer;
    int packCount, transferCount;
};

static int packParameterCount(const struct Abilities* can) { return can->es && can->version < 30 ? 1 : PACK_COUNT; }

/* ES has no byte swapping. */
static int skipped(const struct Abilities* can, int index) { return can->es && (index == 1 || index == 2); }

static int hasReadFramebuffer(const struct Abilities* can) { return can->version >= 30; }
static int hasPackBuffer(const struct Abilities* can) { return can->es ? can->version >= 30 : can->version >= 21; }
static int hasReadBuffer(const struct Abilities* can) { return !can->es || can->version >= 30; }
static int hasFramebuffer(const struct Abilities* can) { return can->es ? can->version >= 20 : 0; }

static void bindRead(const struct Gl* gl, const struct Abilities* can, int name) {
    if (hasReadFramebuffer(can)) {
        gl->bindFramebuffer(GL_READ_FRAMEBUFFER_TARGET, (unsigned)name);
    } else if (hasFramebuffer(can)) {
        gl->bindFramebuffer(GL_FRAMEBUFFER_TARGET, (unsigned)name);
    }
}

static struct Saved saveState(const struct Gl* gl, const struct Abilities* can) {
    struct Saved saved;
    memset(&saved, 0, sizeof saved);
    saved.packCount = packParameterCount(can);
    saved.transferCount = can->compatibility ? TRANSFER_COUNT : 0;
    for (int i = 0; i < saved.packCount; ++i) {
        if (!skipped(can, i)) {
            gl->getIntegerv(packParameters[i].name, &saved.pack[i]);
            gl->pixelStorei(packParameters[i].name, (int)packParameters[i].neutral);
        }
    }
    for (int i = 0; i < saved.transferCount; ++i) {
        gl->getFloatv(transferParameters[i].name, &saved.transfer[i]);
        if (saved.transfer[i] != transferParameters[i].neutral) {
            gl->pixelTransferf(transferParameters[i].name, transferParameters[i].neutral);
        }
    }
    if (hasReadFramebuffer(can) || hasFramebuffer(can)) {
        gl->getIntegerv(hasReadFramebuffer(can) ? GL_READ_FRAMEBUFFER_NAME : GL_FRAMEBUFFER_NAME, &saved.framebuffer);
        bindRead(gl, can, 0);
    }
    if (hasPackBuffer(can)) {
        gl->getIntegerv(GL_PACK_BUFFER_NAME, &saved.packBuffer);
        gl->bindBuffer(GL_PACK_BUFFER_TARGET, 0);
    }
    if (hasReadBuffer(can)) {
        gl->getIntegerv(GL_READ_BUFFER_NAME, &saved.readBuffer);
    }
    return saved;
}

static void restoreState(const struct Gl* gl, const struct Abilities* can, const struct Saved* saved) {
    if (hasReadBuffer(can)) {
        gl->readBuffer((unsigned)saved->readBuffer);
    }
    if (hasPackBuffer(can)) {
        gl->bindBuffer(GL_PACK_BUFFER_TARGET, (unsigned)saved->packBuffer);
    }
    if (saved->framebuffer != 0) {
        bindRead(gl, can, saved->framebuffer);
    }
    for (int i = 0; i < saved->transferCount; ++i) {
        if (saved->transfer[i] != transferParameters[i].neutral) {
            gl->pixelTransferf(transferParameters[i].name, saved->transfer[i]);
        }
    }
    for (int i = 0; i < saved->packCount; ++i) {
        if (!skipped(can, i)) {
            gl->pixelStorei(packParameters[i].name, saved->pack[i]);
        }
    }
}

static void readPicture(LookUpFunction lookUp, int front, int width, int height, uint8_t* rgba) {
    const struct Gl gl = loadGl(lookUp);
    const struct Abilities can = abilitiesOf(&gl);
    const struct Saved saved = saveState(&gl, &can);
    if (hasReadBuffer(&can)) {
        int doubleBuffered = 1;
        if (!can.es) {
            gl.getIntegerv(GL_IS_DOUBLEBUFFERED, &doubleBuffered);
        }
        gl.readBuffer(front || !doubleBuffered ? GL_FRONT_BUFFER : GL_BACK_BUFFER);
    }
    gl.readPixels(0, 0, width, height, GL_RGBA_FORMAT, GL_BYTES, rgba);
    restoreState(&gl, &can, &saved);
}

/* ---- drawables and files ---------------------------------------------------------------------- */

static pthread_mutex_t drawablesLock = PTHREAD_MUTEX_INITIALIZER;
static struct Drawable {
    uintptr_t handle;
    int folder, frames;
} drawables[MAX_DRAWABLES];
static int drawableCount;

static void complain(const char* what, const char* with) {
    fprintf(stderr, "grab: %s %s: %s\n", what, with, strerror(errno));
}

/* Returns the first free number, which also works if the program executes another program that draws. */
static int claimFolder(const char* out) {
    char path[1024];
    for (int number = 0; number < 10000; ++number) {
        snprintf(path, sizeof path, "%s/w%d", out, number);
        if (mkdir(path, 0777) == 0) {
            return number;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    complain("can't make", path);
    return -1;
}

/* Writes the path of the drawable's next frame. Returns 0 if there is no output folder. */
static int nextPath(uintptr_t handle, char* path, size_t sizeBytes) {
    const char* out = getenv("GRAB_OUT");
    if (out == NULL) {
        return 0;
    }
    pthread_mutex_lock(&drawablesLock);
    struct Drawable* found = NULL;
    for (int i = 0; i < drawableCount; ++i) {
        if (drawables[i].handle == handle) {
            found = &drawables[i];
        }
    }
    if (found == NULL && drawableCount < MAX_DRAWABLES) {
        found = &drawables[drawableCount++];
        found->handle = handle;
        found->folder = claimFolder(out);
    }
    const int usable = found != NULL && found->folder >= 0;
    if (usable) {
        snprintf(path, sizeBytes, "%s/w%d/f%04d.ppm", out, found->folder, found->frames++);
    }
    pthread_mutex_unlock(&drawablesLock);
    return usable;
}

static void writePicture(const char* path, int width, int height, const uint8_t* rgba) {
    uint8_t* row = malloc((size_t)width * 3);
    FILE* file = fopen(path, "wb");
    if (row == NULL || file == NULL) {
        complain("can't write", path);
    } else {
        fprintf(file, "P6\n%d %d\n255\n", width, height);
        for (int y = height - 1; y >= 0; --y) {
            const uint8_t* from = rgba + (size_t)y * (size_t)width * 4;
            for (int x = 0; x < width; ++x) {
                memcpy(row + (size_t)x * 3, from + (size_t)x * 4, 3);
            }
            if (fwrite(row, 3, (size_t)width, file) != (size_t)width) {
                complain("can't write", path);
                break;
            }
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    free(row);
}

static void grab(LookUpFunction lookUp, uintptr_t drawable, int front, int width, int height) {
    char path[1100];
    if (width <= 0 || height <= 0 || !nextPath(drawable, path, sizeof path)) {
        return;
    }
    uint8_t* rgba = calloc((size_t)width * (size_t)height, 4);
    if (rgba == NULL) {
        complain("no memory for", path);
        return;
    }
    readPicture(lookUp, front, width, height, rgba);
    writePicture(path, width, height, rgba);
    free(rgba);
}

/* ---- GLX -------------------------------------------------------------------------------------- */

static Function lookUpGlx(const char* name) {
    Function (*find)(const char*) = (Function(*)(const char*))next(GLX_PROC_ARB);
    Function found = find != NULL ? find(name) : NULL;
    return found != NULL ? found : (Function)symbolAfterUs(name);
}

static void grabGlx(void* display, unsigned long drawable, int front) {
    void (*query)(void*, unsigned long, int, unsigned*) =
        (void (*)(void*, unsigned long, int, unsigned*))symbolAfterUs("glXQueryDrawable");
    unsigned width = 0;
    unsigned height = 0;
    if (query != NULL && drawable != 0) {
        query(display, drawable, 0x801D, &width);
        query(display, drawable, 0x801E, &height);
    }
    grab(lookUpGlx, drawable, front, (int)width, (int)height);
}

EXPORT void glXSwapBuffers(void* display, unsigned long drawable) {
    unsigned long (*current)(void) = (unsigned long (*)(void))symbolAfterUs("glXGetCurrentDrawable");
    if (current != NULL && current() == drawable) {
        grabGlx(display, drawable, 0);
    }
    ((void (*)(void*, unsigned long))next(GLX_SWAP))(display, drawable);
}

EXPORT Function glXGetProcAddress(const unsigned char* name) {
    const Function real = ((Function(*)(const unsigned char*))next(GLX_PROC))(name);
    const Function replacement = replace((const char*)name, real);
    return replacement != NULL ? replacement : real;
}

EXPORT Function glXGetProcAddressARB(const unsigned char* name) {
    const Function real = ((Function(*)(const unsigned char*))next(GLX_PROC_ARB))(name);
    const Function replacement = replace((const char*)name, real);
    return replacement != NULL ? replacement : real;
}

static void grabFlushed(void) {
    void* (*display)(void) = (void* (*)(void))symbolAfterUs("glXGetCurrentDisplay");
    unsigned long (*drawable)(void) = (unsigned long (*)(void))symbolAfterUs("glXGetCurrentDrawable");
    if (flushShows() && display != NULL && drawable != NULL && display() != NULL) {
        grabGlx(display(), drawable(), 1);
    }
}

EXPORT void glFlush(void) {
    next(GL_FLUSH)();
    grabFlushed();
}

EXPORT void glFinish(void) {
    next(GL_FINISH)();
    grabFlushed();
}

/* ---- EGL -------------------------------------------------------------------------------------- */

static Function lookUpEgl(const char* name) {
    Function (*find)(const char*) = (Function(*)(const char*))next(EGL_PROC);
    Function found = find != NULL ? find(name) : NULL;
    return found != NULL ? found : (Function)symbolAfterUs(name);
}

static void grabEgl(void* display, void* surface) {
    unsigned (*query)(void*, void*, int, int*) =
        (unsigned (*)(void*, void*, int, int*))symbolAfterUs("eglQuerySurface");
    void* (*current)(int) = (void* (*)(int))symbolAfterUs("eglGetCurrentSurface");
    int width = 0;
    int height = 0;
    if (query == NULL || current == NULL || current(0x3059) != surface) {
        return;
    }
    query(display, surface, 0x3057, &width);
    query(display, surface, 0x3056, &height);
    grab(lookUpEgl, (uintptr_t)surface, 0, width, height);
}

EXPORT unsigned eglSwapBuffers(void* display, void* surface) {
    grabEgl(display, surface);
    return ((unsigned (*)(void*, void*))next(EGL_SWAP))(display, surface);
}

typedef unsigned (*SwapWithDamage)(void*, void*, const int*, int);

EXPORT unsigned eglSwapBuffersWithDamageKHR(void* display, void* surface, const int* rectangles, int count) {
    grabEgl(display, surface);
    return ((SwapWithDamage)next(EGL_SWAP_DAMAGE_KHR))(display, surface, rectangles, count);
}

EXPORT unsigned eglSwapBuffersWithDamageEXT(void* display, void* surface, const int* rectangles, int count) {
    grabEgl(display, surface);
    return ((SwapWithDamage)next(EGL_SWAP_DAMAGE_EXT))(display, surface, rectangles, count);
}

EXPORT Function eglGetProcAddress(const char* name) {
    const Function real = ((Function(*)(const char*))next(EGL_PROC))(name);
    const Function replacement = replace(name, real);
    return replacement != NULL ? replacement : real;
}

static Function replacementOf(enum Hook hook) {
    switch (hook) {
    case GLX_SWAP: return (Function)glXSwapBuffers;
    case GLX_PROC: return (Function)glXGetProcAddress;
    case GLX_PROC_ARB: return (Function)glXGetProcAddressARB;
    case EGL_SWAP: return (Function)eglSwapBuffers;
    case EGL_SWAP_DAMAGE_KHR: return (Function)eglSwapBuffersWithDamageKHR;
    case EGL_SWAP_DAMAGE_EXT: return (Function)eglSwapBuffersWithDamageEXT;
    case EGL_PROC: return (Function)eglGetProcAddress;
    case GL_FLUSH: return (Function)glFlush;
    case GL_FINISH: return (Function)glFinish;
    case HOOK_COUNT: break;
    }
    return NULL;
}
