// Keeps the names returned by glGetStringi beyond the end of EGL, which unloads Mesa's driver with its last display.
// Prints how many can still be read.
#include <EGL/egl.h>

#include <GLES3/gl3.h>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace {

bool mapped(const char* address) {
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    return msync(reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(address) / page * page), 1, MS_ASYNC) == 0 ||
           errno != ENOMEM;
}

} // namespace

int main() {
    EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (!eglInitialize(display, nullptr, nullptr) || !eglChooseConfig(display, wanted, &config, 1, &configs) ||
        configs < 1) {
        std::fprintf(stderr, "kept_names: EGL has no configuration for OpenGL ES 3\n");
        return 1;
    }
    eglBindAPI(EGL_OPENGL_ES_API);
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        std::fprintf(stderr, "kept_names: EGL error 0x%x\n", unsigned(eglGetError()));
        return 1;
    }
    std::vector<const char*> names;
    std::vector<std::string> copies;
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        names.push_back(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i))));
        copies.emplace_back(names.back());
    }
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    eglTerminate(display);
    eglReleaseThread();

    size_t gone = 0;
    for (size_t i = 0; i < names.size(); ++i) {
        gone += !mapped(names[i]) || copies[i] != names[i];
    }
    std::printf("%s, %zu gone\n", names.size() > 20 ? "names" : "few names", gone);
    return 0;
}
