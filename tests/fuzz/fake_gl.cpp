#include "tests/fuzz/fake_gl.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "streamcodec/sizes/pixel_format.hpp"
#include "streamcodec/sizes/vertex_types.hpp"

namespace mural::fuzz {

namespace {

struct State {
    GLuint lastName = 0;
    GLint elementBuffer = 0, unpackBuffer = 0, packBuffer = 0;
    GLint maxSurface = 4096;
    bool current = false; // whether a context is current
    GLenum error = 0;
    GLDEBUGPROC callback = nullptr;
    const void* callbackUser = nullptr;
    std::unordered_set<GLenum> enabled;
    std::array<int, 4> scissor{};
    FakeGlOptions options;
};
State state;

// Reads all bytes, so that a sanitizer checks them. The sum prevents removal of the reads.
volatile uint8_t sink;
void touch(const void* p, size_t bytes) {
    uint8_t sum = 0;
    for (size_t i = 0; i < bytes; ++i) sum = static_cast<uint8_t>(sum + static_cast<const uint8_t*>(p)[i]);
    sink = sum;
}
size_t count(int64_t n, size_t bytes) { return n > 0 ? static_cast<size_t>(n) * bytes : 0; }

uint64_t nothing() { return 0; }
void makeNames(GLsizei n, GLuint* names) {
    for (GLsizei i = 0; i < n; ++i) names[i] = ++state.lastName;
}
void makeNamesOf(GLenum, GLsizei n, GLuint* names) { makeNames(n, names); }
GLuint makeOne() { return ++state.lastName; }
GLuint makeLists(GLsizei n) { return n > 0 ? state.lastName += static_cast<GLuint>(n) : 0; }
GLsync makeFence(GLenum, GLbitfield) { return reinterpret_cast<GLsync>(uintptr_t{++state.lastName}); }
void readNames(GLsizei n, const GLuint* names) { touch(names, count(n, 4)); }

void getIntegerv(GLenum what, GLint* value) {
    *value = what == GL_ELEMENT_ARRAY_BUFFER_BINDING ? state.elementBuffer
             : what == GL_RENDER_MODE                ? GL_RENDER
             : what == GL_STENCIL_WRITEMASK          ? 255
                                                     : 0;
}
void enable(GLenum cap) { state.enabled.insert(cap); }
void disable(GLenum cap) { state.enabled.erase(cap); }
GLboolean isEnabled(GLenum cap) { return state.enabled.contains(cap) ? GL_TRUE : GL_FALSE; }
void scissor(GLint x, GLint y, GLsizei width, GLsizei height) { state.scissor = {x, y, width, height}; }
void drew() {
    if (state.options.drew) state.options.drew(state.enabled.contains(GL_SCISSOR_TEST), state.scissor);
}
void clear(GLbitfield) { drew(); }
void rectf(GLfloat, GLfloat, GLfloat, GLfloat) { drew(); }
void getUniform64(GLuint, GLenum, GLuint64* value) { *value = 7; }
void getUniform32(GLuint, GLenum, GLuint* value) { *value = 7; }
GLint uniformLocation(GLuint, const GLchar* text) { return static_cast<GLint>(std::strlen(text)); }

void bindBuffer(GLenum target, GLuint buffer) {
    const auto bound = static_cast<GLint>(buffer);
    if (target == GL_ELEMENT_ARRAY_BUFFER) state.elementBuffer = bound;
    if (target == GL_PIXEL_UNPACK_BUFFER) state.unpackBuffer = bound;
    if (target == GL_PIXEL_PACK_BUFFER) state.packBuffer = bound;
}
void bufferData(GLenum, GLsizeiptr size, const void* data, GLenum) {
    if (data) touch(data, count(size, 1));
}
void bufferSubData(GLenum, GLintptr, GLsizeiptr size, const void* data) { touch(data, count(size, 1)); }

void readImage(const void* pixels, GLenum format, GLenum type, GLsizei w, GLsizei h, GLsizei d) {
    if (pixels && !state.unpackBuffer) touch(pixels, sizes::tightBytes(format, type, w, h, d));
}
void texImage2d(GLenum, GLint, GLint, GLsizei w, GLsizei h, GLint, GLenum format, GLenum type, const void* pixels) {
    if (state.options.largestTexture && int64_t{w} * h > state.options.largestTexture) state.error = GL_OUT_OF_MEMORY;
    readImage(pixels, format, type, w, h, 1);
}
void texSubImage2d(GLenum, GLint, GLint, GLint, GLsizei w, GLsizei h, GLenum format, GLenum type, const void* pixels) {
    readImage(pixels, format, type, w, h, 1);
}
void texImage3d(GLenum, GLint, GLint, GLsizei w, GLsizei h, GLsizei d, GLint, GLenum format, GLenum type,
                const void* pixels) {
    readImage(pixels, format, type, w, h, d);
}
void drawPixels(GLsizei w, GLsizei h, GLenum format, GLenum type, const void* pixels) {
    readImage(pixels, format, type, w, h, 1);
}
void bitmap(GLsizei w, GLsizei h, GLfloat, GLfloat, GLfloat, GLfloat, const GLubyte* bits) {
    readImage(bits, GL_COLOR_INDEX, GL_BITMAP, w, h, 1);
}
void polygonStipple(const GLubyte* bits) { readImage(bits, GL_COLOR_INDEX, GL_BITMAP, 32, 32, 1); }

void readPixels(GLint, GLint, GLsizei w, GLsizei h, GLenum format, GLenum type, void* pixels) {
    if (pixels && !state.packBuffer) std::memset(pixels, 0x5a, sizes::tightBytes(format, type, w, h, 1));
}
void getTexImage(GLenum, GLint, GLenum, GLenum, GLsizei room, void* pixels) {
    std::memset(pixels, 0x5a, count(room, 1));
}

GLenum getError() { return std::exchange(state.error, GL_NO_ERROR); }
void setCallback(void* callback, const void* user) {
    state.callback = reinterpret_cast<GLDEBUGPROC>(callback);
    state.callbackUser = user;
}
void drawArrays(GLenum, GLint, GLsizei) {
    if (!state.options.talks || !state.callback) return;
    for (const GLenum source : {GL_DEBUG_SOURCE_API, GL_DEBUG_SOURCE_APPLICATION})
        state.callback(source, GL_DEBUG_TYPE_PERFORMANCE, 7, GL_DEBUG_SEVERITY_LOW, -1, "a slow draw",
                       state.callbackUser);
}
GLenum graphicsResetStatus() { return state.options.resetStatus; }

void drawElements(GLenum, GLsizei n, GLenum type, const void* indices) {
    if (!state.elementBuffer) touch(indices, count(n, sizes::typeBytes(type)));
}
void multiDrawElements(GLenum mode, const GLsizei* counts, GLenum type, const void* const* indices, GLsizei draws) {
    for (GLsizei i = 0; i < draws; ++i) drawElements(mode, counts[i], type, indices[i]);
}
void multiDrawArrays(GLenum, const GLint* first, const GLsizei* counts, GLsizei draws) {
    touch(first, count(draws, 4));
    touch(counts, count(draws, 4));
}
void shaderSource(GLuint, GLsizei n, const GLchar* const* texts, const GLint* lengths) {
    for (GLsizei i = 0; i < n; ++i) touch(texts[i], static_cast<size_t>(lengths[i]) + 1);
}
GLuint createShaderProgram(GLenum, GLsizei n, const GLchar* const* texts) {
    for (GLsizei i = 0; i < n; ++i) touch(texts[i], std::strlen(texts[i]) + 1);
    return makeOne();
}
void uniform4fv(GLint, GLsizei n, const GLfloat* values) { touch(values, count(n, 16)); }
// Reads like Mesa, which copies a negative count of values after reporting the error.
void programParameters(GLuint, GLenum, GLuint, GLsizei n, const GLfloat* values) {
    touch(values, static_cast<size_t>(n) * 16);
}
void uniformMatrix4fv(GLint, GLsizei n, GLboolean, const GLfloat* values) { touch(values, count(n, 64)); }
void uniformMatrix4dv(GLint, GLsizei n, GLboolean, const GLdouble* values) { touch(values, count(n, 128)); }
template <size_t bytes> void readFixed(const void* values) { touch(values, bytes); }
void chooseBuffer(GLenum name) {
    if (state.options.namedBuffer) state.options.namedBuffer(name);
}
void drawBuffers(GLsizei n, const GLenum* buffers) {
    for (GLsizei i = 0; i < n; ++i) chooseBuffer(buffers[i]);
}
void invalidate(GLenum, GLsizei n, const GLenum* attachments) { touch(attachments, count(n, 4)); }
void texParameterfv(GLenum, GLenum name, const GLfloat* values) {
    touch(values, name == GL_TEXTURE_BORDER_COLOR ? 16 : 4);
}
void lightfv(GLenum, GLenum name, const GLfloat* values) {
    touch(values, name >= GL_AMBIENT && name <= GL_POSITION ? 16 : 4);
}

// Ends the process in calls without a context. GL ignores them, but libepoxy ends the process.
template <auto function> struct InContext;
template <class R, class... Arguments, R (*function)(Arguments...)> struct InContext<function> {
    static R call(Arguments... arguments) {
        if (state.current) return function(arguments...);
        std::fputs("fake_gl: the replay calls GL while no context is current\n", stderr);
        std::abort();
    }
};
template <auto function> gl::Proc proc() { return reinterpret_cast<gl::Proc>(InContext<function>::call); }

const std::unordered_map<std::string, gl::Proc>& special() {
    static const std::unordered_map<std::string, gl::Proc> table = {
        {"glGetIntegerv", proc<getIntegerv>()},
        {"glGetQueryObjectui64v", proc<getUniform64>()},
        {"glGetQueryObjectuiv", proc<getUniform32>()},
        {"glEnable", proc<enable>()},
        {"glDisable", proc<disable>()},
        {"glIsEnabled", proc<isEnabled>()},
        {"glScissor", proc<scissor>()},
        {"glClear", proc<clear>()},
        {"glRectf", proc<rectf>()},
        {"glGetUniformLocation", proc<uniformLocation>()},
        {"glBindBuffer", proc<bindBuffer>()},
        {"glBufferData", proc<bufferData>()},
        {"glBufferSubData", proc<bufferSubData>()},
        {"glTexImage2D", proc<texImage2d>()},
        {"glGetError", proc<getError>()},
        {"glDebugMessageCallback", proc<setCallback>()},
        {"glDrawArrays", proc<drawArrays>()},
        {"glGetGraphicsResetStatus", proc<graphicsResetStatus>()},
        {"glTexSubImage2D", proc<texSubImage2d>()},
        {"glTexImage3D", proc<texImage3d>()},
        {"glDrawPixels", proc<drawPixels>()},
        {"glBitmap", proc<bitmap>()},
        {"glPolygonStipple", proc<polygonStipple>()},
        {"glReadPixels", proc<readPixels>()},
        {"glGetnTexImageARB", proc<getTexImage>()},
        {"glGetnTexImage", proc<getTexImage>()},
        {"glGetTextureImage", proc<getTexImage>()},
        {"glDrawElements", proc<drawElements>()},
        {"glMultiDrawElements", proc<multiDrawElements>()},
        {"glMultiDrawArrays", proc<multiDrawArrays>()},
        {"glShaderSource", proc<shaderSource>()},
        {"glCreateShaderProgramv", proc<createShaderProgram>()},
        {"glUniform4fv", proc<uniform4fv>()},
        {"glUniformMatrix4fv", proc<uniformMatrix4fv>()},
        {"glUniformMatrix4dv", proc<uniformMatrix4dv>()},
        {"glLoadMatrixd", proc<readFixed<128>>()},
        {"glMultMatrixf", proc<readFixed<64>>()},
        {"glWindowPos2fv", proc<readFixed<8>>()},
        {"glWindowPos3dv", proc<readFixed<24>>()},
        {"glWindowPos4dvMESA", proc<readFixed<32>>()},
        {"glVertex3fv", proc<readFixed<12>>()},
        {"glDrawBuffers", proc<drawBuffers>()},
        {"glDrawBuffer", proc<chooseBuffer>()},
        {"glReadBuffer", proc<chooseBuffer>()},
        {"glInvalidateFramebuffer", proc<invalidate>()},
        {"glTexParameterfv", proc<texParameterfv>()},
        {"glLightfv", proc<lightfv>()},
        {"glFenceSync", proc<makeFence>()},
        {"glGenLists", proc<makeLists>()},
        {"glCreateShader", proc<makeOne>()},
        {"glCreateProgram", proc<makeOne>()},
        {"glNamedProgramLocalParameters4fvEXT", proc<programParameters>()},
        {"glCreateTextures", proc<makeNamesOf>()},
        {"glCreateQueries", proc<makeNamesOf>()}};
    return table;
}

class FakeSurface : public gl::Surface {
public:
    FakeSurface(const gl::SurfaceConfig& config, gl::ColorBuffers buffers) : config_(config), buffers_(buffers) {}
    [[nodiscard]] const gl::SurfaceConfig& config() const override { return config_; }
    [[nodiscard]] gl::ColorBuffers colorBuffers() const override { return buffers_; }

private:
    gl::SurfaceConfig config_;
    gl::ColorBuffers buffers_;
};

class FakeContext : public gl::Context {
public:
    explicit FakeContext(bool reportsReset) : reportsReset_(reportsReset) {}
    [[nodiscard]] bool reportsReset() const override { return reportsReset_; }

private:
    bool reportsReset_;
};

// Tracks live and current objects: a current surface or context must not be destroyed.
class FakePlatform : public gl::Platform {
public:
    explicit FakePlatform(const FakeGlOptions& options) : options_(options) {
        state = {};
        state.options = options;
    }
    Result<std::unique_ptr<gl::Surface>> createSurface(const gl::SurfaceConfig& c) override {
        if (options_.surfacesFail || c.width > state.maxSurface || c.height > state.maxSurface)
            return Error{"too large"};
        return std::unique_ptr<gl::Surface>(new FakeSurface(c, options_.colorBuffers));
    }
    Result<std::unique_ptr<gl::Context>> createContext(const gl::ContextConfig& c, gl::Context* share) override {
        if (c.major > 9) return Error{"no such version"};
        if (share && !dynamic_cast<gl::Context*>(share)) return Error{"a share context that is gone"};
        return std::unique_ptr<gl::Context>(new FakeContext(c.reportsReset));
    }
    Result<void> makeCurrent(gl::Context* context, gl::Surface* draw, gl::Surface* read, gl::PendingCommands) override {
        // A change of context flushes the old surfaces and reads the new ones, so all must be alive.
        for (const gl::Surface* s :
             {draw_, read_, static_cast<const gl::Surface*>(draw), static_cast<const gl::Surface*>(read)}) {
            if (s) sink = static_cast<uint8_t>(s->width());
        }
        state.current = context != nullptr;
        draw_ = context ? draw : nullptr;
        read_ = context ? read : nullptr;
        return {};
    }
    gl::Proc getProcAddress(const char* text) override {
        const std::string name = text;
        if (const auto it = special().find(name); it != special().end()) return it->second;
        if (name.starts_with("glGen") && name != "glGenerateMipmap" && name.find("Symbols") == std::string::npos &&
            !name.starts_with("glGenerate") && name != "glGenPathsNV" && name != "glGenAsyncMarkersSGIX" &&
            name != "glGenFragmentShadersATI" && name != "glGenVertexShadersEXT")
            return proc<makeNames>();
        if (name.starts_with("glCreate") && name.ends_with("s")) return proc<makeNames>();
        if (name.starts_with("glDelete") && name.ends_with("s") && name != "glDeleteLists") return proc<readNames>();
        return proc<nothing>();
    }
    [[nodiscard]] std::string describe() const override { return "no GL at all"; }

private:
    FakeGlOptions options_;
    const gl::Surface* draw_ = nullptr;
    const gl::Surface* read_ = nullptr;
};

} // namespace

std::unique_ptr<gl::Platform> makeFakePlatform(const FakeGlOptions& options) {
    return std::make_unique<FakePlatform>(options);
}

} // namespace mural::fuzz
