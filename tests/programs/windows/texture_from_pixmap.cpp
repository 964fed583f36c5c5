// X pixmaps as textures (GLX_EXT_texture_from_pixmap), as compositing window managers use them: drawn by X, bound,
// drawn again, bound again.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>

using namespace programs;

namespace {

constexpr int kWidth = 64, kHeight = 48;

Display* display;
PFNGLXBINDTEXIMAGEEXTPROC bindTexImage;
PFNGLXRELEASETEXIMAGEEXTPROC releaseTexImage;

struct Config {
    GLXFBConfig handle;
    int depth; // depth of its visual
};

// Chooses pixmaps with the depth that the picture needs: 32 bits with alpha.
Config chooseConfig(int attribute, int depth) {
    const int attributes[] = {GLX_DRAWABLE_TYPE,
                              GLX_PIXMAP_BIT | GLX_WINDOW_BIT,
                              GLX_RED_SIZE,
                              8,
                              GLX_GREEN_SIZE,
                              8,
                              GLX_BLUE_SIZE,
                              8,
                              attribute,
                              True,
                              None};
    int count = 0;
    GLXFBConfig* found = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
    for (int i = 0; i < count; ++i) {
        XVisualInfo* visual = glXGetVisualFromFBConfig(display, found[i]);
        const int depthHere = visual == nullptr ? 0 : visual->depth;
        XFree(visual);
        if (depthHere == depth) {
            const Config config = {found[i], depth};
            XFree(found);
            return config;
        }
    }
    fail("no GLX configuration for pixmaps of %d bits as textures", depth);
}

struct Source {
    Pixmap pixmap;
    GLXPixmap drawable;
    GLenum target;
    bool inverted;
    GLuint texture;
};

Source makeSource(GLenum target, bool alpha) {
    Source s = {};
    const Config config =
        chooseConfig(alpha ? GLX_BIND_TO_TEXTURE_RGBA_EXT : GLX_BIND_TO_TEXTURE_RGB_EXT, alpha ? 32 : 24);
    s.pixmap = XCreatePixmap(display, DefaultRootWindow(display), kWidth, kHeight, unsigned(config.depth));
    const int attributes[] = {
        GLX_TEXTURE_TARGET_EXT, target == GL_TEXTURE_2D ? GLX_TEXTURE_2D_EXT : GLX_TEXTURE_RECTANGLE_EXT,
        GLX_TEXTURE_FORMAT_EXT, alpha ? GLX_TEXTURE_FORMAT_RGBA_EXT : GLX_TEXTURE_FORMAT_RGB_EXT, None};
    s.drawable = glXCreatePixmap(display, config.handle, s.pixmap, attributes);
    s.target = target;
    int inverted = 0;
    glXGetFBConfigAttrib(display, config.handle, GLX_Y_INVERTED_EXT, &inverted);
    s.inverted = inverted == True;
    glGenTextures(1, &s.texture);
    glBindTexture(target, s.texture);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return s;
}

void drawByX(const Source& s, int frame) {
    const GC gc = XCreateGC(display, s.pixmap, 0, nullptr);
    for (int i = 0; i < 9; ++i) {
        XSetForeground(display, gc,
                       0xff000000U |
                           unsigned(i * 0x1b2d3f + frame * 0x102030 + (s.target == GL_TEXTURE_2D ? 0 : 0x55)));
        if (i == 0) {
            XFillRectangle(display, s.pixmap, gc, 0, 0, kWidth, kHeight);
        } else {
            XFillRectangle(display, s.pixmap, gc, i * 6, (i * 7 + frame * 5) % 40, 9, unsigned(4 + i));
        }
    }
    XFreeGC(display, gc);
    XSync(display, False);
}

void drawTextured(const Source& s, float x, float y) {
    const float right = s.target == GL_TEXTURE_2D ? 1 : kWidth, top = s.target == GL_TEXTURE_2D ? 1 : kHeight;
    glEnable(s.target);
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; ++i) {
        const float u = i == 1 || i == 2 ? 1 : 0, v = i >= 2 ? 1 : 0;
        glTexCoord2f(u * right, (s.inverted ? 1 - v : v) * top);
        glVertex2f(x + u * 0.9F, y + v * 0.8F + u * 0.05F);
    }
    glEnd();
    glDisable(s.target);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    bindTexImage = reinterpret_cast<PFNGLXBINDTEXIMAGEEXTPROC>(
        glXGetProcAddress(reinterpret_cast<const GLubyte*>("glXBindTexImageEXT")));
    releaseTexImage = reinterpret_cast<PFNGLXRELEASETEXIMAGEEXTPROC>(
        glXGetProcAddress(reinterpret_cast<const GLubyte*>("glXReleaseTexImageEXT")));
    if (bindTexImage == nullptr || releaseTexImage == nullptr) {
        fail("no GLX_EXT_texture_from_pixmap");
    }
    const Source sources[] = {makeSource(GL_TEXTURE_2D, false), makeSource(GL_TEXTURE_RECTANGLE, false),
                              makeSource(GL_TEXTURE_2D, true)};
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F, 0.2F, 0.1F * float(frame % 8), 1);
        glClear(GL_COLOR_BUFFER_BIT);
        for (int i = 0; i < 3; ++i) {
            const Source& s = sources[i];
            drawByX(s, frame);
            glBindTexture(s.target, s.texture);
            glPixelStorei(GL_PACK_ROW_LENGTH, 3 + i); // must not affect pixmaps
            bindTexImage(display, s.drawable, GLX_FRONT_LEFT_EXT, nullptr);
            drawTextured(s, -0.95F + 0.5F * float(i), -0.9F + 0.45F * float(i));
            releaseTexImage(display, s.drawable, GLX_FRONT_LEFT_EXT);
        }
        checkNoError("with pixmaps as textures");
        window->swap();
    }
    return 0;
}
