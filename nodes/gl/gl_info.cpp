#include "nodes/gl/gl_info.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <string_view>

#include <GL/gl.h>
#include <GL/glext.h>

namespace mural::gl {
namespace {

struct Queries {
    const GLubyte* (*getString)(GLenum) = nullptr;
    const GLubyte* (*getStringi)(GLenum, GLuint) = nullptr;
    void (*getIntegerv)(GLenum, GLint*) = nullptr;
    GLenum (*getError)() = nullptr;
};

template <class Function> void load(Platform& platform, Function& function, const char* name) {
    function = reinterpret_cast<Function>(platform.getProcAddress(name));
}

std::string text(const Queries& gl, GLenum name) {
    const GLubyte* value = gl.getString(name);
    return value ? reinterpret_cast<const char*>(value) : "";
}

// Core contexts have only the indexed query, versions before 3.0 only the string.
std::vector<std::string> readExtensions(const Queries& gl, int glVersion) {
    std::vector<std::string> extensions;
    if (glVersion >= 30 && gl.getStringi) {
        GLint count = 0;
        gl.getIntegerv(GL_NUM_EXTENSIONS, &count);
        for (GLint i = 0; i < count; i++)
            if (const GLubyte* name = gl.getStringi(GL_EXTENSIONS, static_cast<GLuint>(i)))
                extensions.emplace_back(reinterpret_cast<const char*>(name));
    } else {
        std::istringstream words(text(gl, GL_EXTENSIONS));
        for (std::string word; words >> word;) extensions.push_back(word);
    }
    std::sort(extensions.begin(), extensions.end());
    return extensions;
}

} // namespace

int parseGlVersion(const std::string& version) {
    for (size_t i = 0; i + 2 < version.size(); i++)
        if (std::isdigit(static_cast<unsigned char>(version[i])) && version[i + 1] == '.' &&
            std::isdigit(static_cast<unsigned char>(version[i + 2])))
            return 10 * (version[i] - '0') + (version[i + 2] - '0');
    return 0;
}

int parseMesaVersion(const std::string& version) {
    constexpr std::string_view name = " Mesa ";
    const size_t at = version.find(name);
    if (at == std::string::npos) return 0;
    int major = 0;
    std::from_chars(version.data() + at + name.size(), version.data() + version.size(), major);
    return major;
}

Result<GlInfo> readGlInfo(Platform& platform) {
    Queries gl;
    load(platform, gl.getString, "glGetString");
    load(platform, gl.getStringi, "glGetStringi");
    load(platform, gl.getIntegerv, "glGetIntegerv");
    load(platform, gl.getError, "glGetError");
    if (!gl.getString || !gl.getIntegerv || !gl.getError)
        return Error{"the GL driver hands out no glGetString: reinstall the GL driver"};
    GlInfo info;
    info.version = text(gl, GL_VERSION);
    info.vendor = text(gl, GL_VENDOR);
    info.renderer = text(gl, GL_RENDERER);
    info.glVersion = parseGlVersion(info.version);
    if (info.glVersion == 0)
        return Error{"the GL driver reports no version ('" + info.version + "'): see mural doctor"};
    info.es = info.version.rfind("OpenGL ES", 0) == 0;
    info.extensions = readExtensions(gl, info.glVersion);
    GLint dimensions[2] = {0, 0};
    gl.getIntegerv(GL_MAX_VIEWPORT_DIMS, dimensions);
    info.maxSurfaceSize = std::min(dimensions[0], dimensions[1]);
    if (!info.es) {
        GLint doubled = 0, drawn = GL_FRONT;
        gl.getIntegerv(GL_DOUBLEBUFFER, &doubled);
        gl.getIntegerv(GL_DRAW_BUFFER, &drawn);
        const bool back = drawn == GL_BACK || drawn == GL_BACK_LEFT;
        info.colorBuffers = doubled ? ColorBuffers::FrontAndBack
                            : back  ? ColorBuffers::OneNamedBack
                                    : ColorBuffers::OneNamedFront;
    }
    // Clears the errors of unsupported queries. Bounded, because a lost context reports errors forever.
    for (int i = 0; i < 16 && gl.getError() != GL_NO_ERROR; i++) {}
    return info;
}

Result<GlInfo> measureGl(Platform& platform, bool embedded) {
    auto surface = platform.createSurface(SurfaceConfig());
    if (!surface) return surface.error();
    auto context = platform.createContext(ContextConfig(), nullptr);
    if (!context && embedded) {
        ContextConfig es;
        es.api = Api::Es2;
        es.major = 2;
        context = platform.createContext(es, nullptr);
    }
    if (!context) return context.error();
    if (auto current = platform.makeCurrent(context->get(), surface->get(), surface->get()); !current)
        return current.error();
    auto info = readGlInfo(platform);
    auto released = platform.makeCurrent(nullptr, nullptr, nullptr);
    if (info && !released) return released.error();
    return info;
}

void finishDrawing(Platform& platform) {
    void (*finish)() = nullptr;
    load(platform, finish, "glFinish");
    if (finish) finish();
}

void flushDrawing(Platform& platform) {
    void (*flush)() = nullptr;
    load(platform, flush, "glFlush");
    if (flush) flush();
}

bool showsSamples(Platform& platform) {
    ContextConfig config;
    config.surface.samples = 4;
    auto surface = platform.createSurface(config.surface);
    if (!surface) return true;
    auto context = platform.createContext(config, nullptr);
    if (!context || !platform.makeCurrent(context->get(), surface->get(), surface->get())) return true;
    void (*clearColor)(GLfloat, GLfloat, GLfloat, GLfloat) = nullptr;
    void (*clear)(GLbitfield) = nullptr;
    void (*readPixels)(GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, void*) = nullptr;
    load(platform, clearColor, "glClearColor");
    load(platform, clear, "glClear");
    load(platform, readPixels, "glReadPixels");
    GLubyte pixel[4] = {};
    if (clearColor && clear && readPixels) {
        clearColor(0, 1, 0, 1);
        clear(GL_COLOR_BUFFER_BIT);
        readPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    }
    (void)platform.makeCurrent(nullptr, nullptr, nullptr);
    return pixel[1] == 255;
}

} // namespace mural::gl
