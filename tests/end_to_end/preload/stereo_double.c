/* Simulates quad-buffered stereo windows, which no driver of the test machines has: a library for LD_AUDIT between the
 * wall windows of `mural head` (GLFW) and GLX. LD_PRELOAD is not possible, because mural run removes it from the head.
 *
 * Every framebuffer config reports stereo. GL_BACK_LEFT is the window's real back buffer. GL_BACK_RIGHT is a texture of
 * the window's size. A swap writes both to files (STEREO_OUT/w0/f0000.left.ppm, f0000.right.ppm, …; one folder per
 * drawable). It then fills both with magenta, so that pixels that the next frame does not draw are visible. GL_BACK
 * would denote both buffers. Drawing there ends the process, and so does any use of the right buffer that is not
 * implemented. STEREO_OUT=folder   without it the library does nothing
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <link.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define EXPORT __attribute__((visibility("default")))

typedef void (*Function)(void);
typedef Function (*LookUpFunction)(const unsigned char*);

enum {
    GLX_IS_STEREO = 6,
    GLX_DRAWABLE_WIDTH = 0x801D,
    GLX_DRAWABLE_HEIGHT = 0x801E,
    GL_BACK_BUFFER = 0x0405,
    GL_LEFT_BACK = 0x0402,
    GL_RIGHT_BACK = 0x0403,
    GL_IS_STEREO = 0x0C33,
    GL_TEXTURE2D = 0x0DE1,
    GL_BYTES = 0x1401,
    GL_RGB_FORMAT = 0x1907,
    GL_RGBA_FORMAT = 0x1908,
    GL_RGBA8_FORMAT = 0x8058,
    GL_TEXTURE2D_NAME = 0x8069,
    GL_READ_BUFFER_NAME = 0x0C02,
    GL_PACK_ALIGN = 0x0D05,
    GL_READ_TARGET = 0x8CA8,
    GL_DRAW_TARGET = 0x8CA9,
    GL_BOTH_TARGETS = 0x8D40,
    GL_DRAW_NAME = 0x8CA6,
    GL_READ_NAME = 0x8CAA,
    GL_COLOR0 = 0x8CE0,
    GL_COLOR_BITS = 0x4000,
    GL_CLEAR_COLOUR = 0x0C22,
    MAX_WINDOWS = 16
};

static struct {
    int (*configAttribute)(void*, void*, int, int*);
    void (*swap)(void*, unsigned long);
    LookUpFunction lookUp;
    unsigned long (*currentDrawable)(void);
    void* (*currentDisplay)(void);
    void (*queryDrawable)(void*, unsigned long, int, unsigned*);
    void (*drawBuffer)(unsigned);
    void (*readBuffer)(unsigned);
    void (*bindFramebuffer)(unsigned, unsigned);
    void (*genFramebuffers)(int, unsigned*);
    void (*framebufferTexture2D)(unsigned, unsigned, unsigned, unsigned, int);
    void (*genTextures)(int, unsigned*);
    void (*bindTexture)(unsigned, unsigned);
    void (*texImage2D)(unsigned, int, int, int, int, int, unsigned, unsigned, const void*);
    void (*getIntegerv)(unsigned, int*);
    void (*getBooleanv)(unsigned, unsigned char*);
    void (*getFloatv)(unsigned, float*);
    void (*readPixels)(int, int, int, int, unsigned, unsigned, void*);
    void (*pixelStorei)(unsigned, int);
    void (*clear)(unsigned);
    void (*clearColor)(float, float, float, float);
} real;

static struct Window {
    unsigned long drawable;
    unsigned framebuffer, texture;
    int width, height;
    int right; /* 1: draws to the window go to the buffer of the right eye */
    int frames;
} windows[MAX_WINDOWS];
static int windowCount;

static void fail(const char* what) {
    fprintf(stderr, "stereo_double: %s\n", what);
    abort();
}

/* Returns 1 in the head, which opens the wall windows. Programs and nodes use the real GLX. */
static int active(void) {
    static int known = -1;
    if (known < 0) {
        char line[256] = "";
        FILE* file = fopen("/proc/self/cmdline", "rb");
        const size_t bytes = file ? fread(line, 1, sizeof line - 1, file) : 0;
        if (file) {
            fclose(file);
        }
        const size_t first = strlen(line) + 1;
        known = getenv("STEREO_OUT") != NULL && first < bytes && strcmp(line + first, "head") == 0;
    }
    return known;
}

static Function glFunction(const char* name) {
    const Function found = real.lookUp ? real.lookUp((const unsigned char*)name) : NULL;
    if (found == NULL) {
        fail(name);
    }
    return found;
}

static void loadGl(void) {
    if (real.clear != NULL) {
        return;
    }
    real.currentDrawable = (unsigned long (*)(void))glFunction("glXGetCurrentDrawable");
    real.currentDisplay = (void* (*)(void))glFunction("glXGetCurrentDisplay");
    real.queryDrawable = (void (*)(void*, unsigned long, int, unsigned*))glFunction("glXQueryDrawable");
    real.drawBuffer = (void (*)(unsigned))glFunction("glDrawBuffer");
    real.readBuffer = (void (*)(unsigned))glFunction("glReadBuffer");
    real.bindFramebuffer = (void (*)(unsigned, unsigned))glFunction("glBindFramebuffer");
    real.genFramebuffers = (void (*)(int, unsigned*))glFunction("glGenFramebuffers");
    real.framebufferTexture2D =
        (void (*)(unsigned, unsigned, unsigned, unsigned, int))glFunction("glFramebufferTexture2D");
    real.genTextures = (void (*)(int, unsigned*))glFunction("glGenTextures");
    real.bindTexture = (void (*)(unsigned, unsigned))glFunction("glBindTexture");
    real.texImage2D =
        (void (*)(unsigned, int, int, int, int, int, unsigned, unsigned, const void*))glFunction("glTexImage2D");
    real.getIntegerv = (void (*)(unsigned, int*))glFunction("glGetIntegerv");
    real.getBooleanv = (void (*)(unsigned, unsigned char*))glFunction("glGetBooleanv");
    real.getFloatv = (void (*)(unsigned, float*))glFunction("glGetFloatv");
    real.readPixels = (void (*)(int, int, int, int, unsigned, unsigned, void*))glFunction("glReadPixels");
    real.pixelStorei = (void (*)(unsigned, int))glFunction("glPixelStorei");
    real.clearColor = (void (*)(float, float, float, float))glFunction("glClearColor");
    real.clear = (void (*)(unsigned))glFunction("glClear");
}

/* ---- the two buffers -------------------------------------------------------------------------- */

/* Returns the state of the current drawable, after resizing its right buffer to the window's size. */
static struct Window* current(void) {
    loadGl();
    const unsigned long drawable = real.currentDrawable();
    struct Window* w = NULL;
    for (int i = 0; i < windowCount; ++i) {
        if (windows[i].drawable == drawable) {
            w = &windows[i];
        }
    }
    if (w == NULL) {
        if (windowCount == MAX_WINDOWS) {
            fail("too many windows");
        }
        w = &windows[windowCount++];
        w->drawable = drawable;
        real.genFramebuffers(1, &w->framebuffer);
        real.genTextures(1, &w->texture);
    }
    unsigned width = 0, height = 0;
    real.queryDrawable(real.currentDisplay(), drawable, GLX_DRAWABLE_WIDTH, &width);
    real.queryDrawable(real.currentDisplay(), drawable, GLX_DRAWABLE_HEIGHT, &height);
    if (width == 0 || height == 0) {
        fail("a drawable without a size");
    }
    if ((int)width != w->width || (int)height != w->height) {
        int texture = 0, draw = 0;
        w->width = (int)width;
        w->height = (int)height;
        real.getIntegerv(GL_TEXTURE2D_NAME, &texture);
        real.getIntegerv(GL_DRAW_NAME, &draw);
        real.bindTexture(GL_TEXTURE2D, w->texture);
        real.texImage2D(GL_TEXTURE2D, 0, GL_RGBA8_FORMAT, w->width, w->height, 0, GL_RGBA_FORMAT, GL_BYTES, NULL);
        real.bindTexture(GL_TEXTURE2D, (unsigned)texture);
        real.bindFramebuffer(GL_DRAW_TARGET, w->framebuffer);
        real.framebufferTexture2D(GL_DRAW_TARGET, GL_COLOR0, GL_TEXTURE2D, w->texture, 0);
        real.bindFramebuffer(GL_DRAW_TARGET, (unsigned)draw);
    }
    return w;
}

static void drawBuffer(unsigned buffer) {
    struct Window* w = current();
    int bound = 0;
    real.getIntegerv(GL_DRAW_NAME, &bound);
    if (bound != 0 && (unsigned)bound != w->framebuffer) {
        real.drawBuffer(buffer);
        return;
    }
    if (buffer != GL_LEFT_BACK && buffer != GL_RIGHT_BACK) {
        fail("what is drawn goes to another buffer than one of both back ones");
    }
    w->right = buffer == GL_RIGHT_BACK;
    real.bindFramebuffer(GL_DRAW_TARGET, w->right ? w->framebuffer : 0);
    real.drawBuffer(w->right ? GL_COLOR0 : GL_BACK_BUFFER);
}

static void bindFramebuffer(unsigned target, unsigned framebuffer) {
    struct Window* w = current();
    real.bindFramebuffer(target, framebuffer);
    if (framebuffer == 0 && w->right && target != GL_READ_TARGET) {
        real.bindFramebuffer(GL_DRAW_TARGET, w->framebuffer);
    }
}

static void getBooleanv(unsigned name, unsigned char* value) {
    loadGl();
    if (name == GL_IS_STEREO) {
        *value = 1;
    } else {
        real.getBooleanv(name, value);
    }
}

/* ---- swaps ------------------------------------------------------------------------------------ */

static void writePicture(const struct Window* w, const char* eye) {
    char path[1024];
    const size_t rowBytes = (size_t)w->width * 3;
    unsigned char* rgb = malloc(rowBytes * (size_t)w->height + 1);
    if (rgb == NULL) {
        fail("no memory");
    }
    real.readPixels(0, 0, w->width, w->height, GL_RGB_FORMAT, GL_BYTES, rgb);
    snprintf(path, sizeof path, "%s/w%d", getenv("STEREO_OUT"), (int)(w - windows));
    if (mkdir(path, 0777) != 0 && errno != EEXIST) {
        fail(path);
    }
    snprintf(path, sizeof path, "%s/w%d/f%04d.%s.ppm", getenv("STEREO_OUT"), (int)(w - windows), w->frames, eye);
    FILE* file = fopen(path, "wb");
    if (file == NULL) {
        fail(path);
    }
    fprintf(file, "P6\n%d %d\n255\n", w->width, w->height);
    for (int y = w->height - 1; y >= 0; --y) {
        if (fwrite(rgb + rowBytes * (size_t)y, 1, rowBytes, file) != rowBytes) {
            fail(path);
        }
    }
    if (fclose(file) != 0) {
        fail(path);
    }
    free(rgb);
}

static void swap(void* display, unsigned long drawable) {
    struct Window* w = current();
    int draw = 0, read = 0, buffer = 0, align = 0;
    float colour[4];
    real.getIntegerv(GL_DRAW_NAME, &draw);
    real.getIntegerv(GL_READ_NAME, &read);
    real.getIntegerv(GL_PACK_ALIGN, &align);
    real.getFloatv(GL_CLEAR_COLOUR, colour);
    real.pixelStorei(GL_PACK_ALIGN, 1);
    real.clearColor(1, 0, 1, 1);
    for (int right = 0; right < 2; ++right) {
        real.bindFramebuffer(GL_READ_TARGET, right ? w->framebuffer : 0);
        real.getIntegerv(GL_READ_BUFFER_NAME, &buffer);
        real.readBuffer(right ? GL_COLOR0 : GL_BACK_BUFFER);
        writePicture(w, right ? "right" : "left");
        real.readBuffer((unsigned)buffer);
    }
    ++w->frames;
    real.bindFramebuffer(GL_READ_TARGET, (unsigned)read);
    real.swap(display, drawable);
    for (int right = 0; right < 2; ++right) {
        real.bindFramebuffer(GL_DRAW_TARGET, right ? w->framebuffer : 0);
        real.clear(GL_COLOR_BITS);
    }
    real.bindFramebuffer(GL_DRAW_TARGET, (unsigned)draw);
    real.pixelStorei(GL_PACK_ALIGN, align);
    real.clearColor(colour[0], colour[1], colour[2], colour[3]);
}

static int configAttribute(void* display, void* config, int attribute, int* value) {
    const int done = real.configAttribute(display, config, attribute, value);
    if (done == 0 && attribute == GLX_IS_STEREO) {
        *value = 1;
    }
    return done;
}

/* ---- function lookup -------------------------------------------------------------------------- */

static Function lookUp(const unsigned char* name);

/* Returns the replacement for `found`. NULL: the function is not replaced. */
static Function replacementOf(const char* name, Function found) {
    if (strcmp(name, "glXGetFBConfigAttrib") == 0) {
        real.configAttribute = (int (*)(void*, void*, int, int*))found;
        return (Function)configAttribute;
    }
    if (strcmp(name, "glXSwapBuffers") == 0) {
        real.swap = (void (*)(void*, unsigned long))found;
        return (Function)swap;
    }
    if (strcmp(name, "glXGetProcAddress") == 0 || strcmp(name, "glXGetProcAddressARB") == 0) {
        real.lookUp = (LookUpFunction)found;
        return (Function)lookUp;
    }
    if (strcmp(name, "glDrawBuffer") == 0) {
        return (Function)drawBuffer;
    }
    if (strcmp(name, "glBindFramebuffer") == 0) {
        return (Function)bindFramebuffer;
    }
    if (strcmp(name, "glGetBooleanv") == 0) {
        return (Function)getBooleanv;
    }
    return NULL;
}

static Function lookUp(const unsigned char* name) {
    const Function found = real.lookUp(name);
    const Function replacement = found ? replacementOf((const char*)name, found) : NULL;
    return replacement ? replacement : found;
}

/* ---- audit interface of the dynamic linker: intercepts GLFW's lookups in the GL libraries --------- */

EXPORT unsigned la_version(unsigned version) { return active() ? version : 0; /* 0: nothing is audited */ }

EXPORT unsigned la_objopen(struct link_map* map, Lmid_t where, uintptr_t* cookie) {
    (void)where;
    *cookie = (uintptr_t)map;
    if (strstr(map->l_name, "libglfw") != NULL) {
        return LA_FLG_BINDFROM;
    }
    return strstr(map->l_name, "libGL") != NULL ? LA_FLG_BINDTO : 0;
}

EXPORT uintptr_t la_symbind64(Elf64_Sym* symbol, unsigned index, uintptr_t* from, uintptr_t* to, unsigned* flags,
                              const char* name) {
    (void)index;
    (void)from;
    (void)to;
    (void)flags;
    const Function found = (Function)symbol->st_value;
    const Function replacement = replacementOf(name, found);
    return (uintptr_t)(replacement ? replacement : found);
}
