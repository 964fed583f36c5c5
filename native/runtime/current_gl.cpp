#include "native/runtime/current_gl.hpp"

#include "native/runtime/gl_loader.hpp"

namespace mural::native {

namespace {
thread_local GlTarget* current = nullptr;
} // namespace

void setCurrentTarget(GlTarget* target) { current = target; }
const GlCalls& currentGl() { return current->gl(); }
gl::Proc currentGlProc(const char* name) { return current ? current->procAddress(name) : nullptr; }

Result<ShaderCalls> ShaderCalls::load() {
    if (!current) return Error{"no renderer runs in this thread; call this function from a task of the Renderer"};
    ShaderCalls calls;
    GlLoader loader(currentGlProc);
    loader.load("glCreateShader", calls.createShader);
    loader.load("glShaderSource", calls.shaderSource);
    loader.load("glCompileShader", calls.compileShader);
    loader.load("glGetShaderiv", calls.getShaderiv);
    loader.load("glGetShaderInfoLog", calls.getShaderInfoLog);
    loader.load("glDeleteShader", calls.deleteShader);
    loader.load("glCreateProgram", calls.createProgram);
    loader.load("glAttachShader", calls.attachShader);
    loader.load("glLinkProgram", calls.linkProgram);
    loader.load("glGetProgramiv", calls.getProgramiv);
    loader.load("glGetProgramInfoLog", calls.getProgramInfoLog);
    loader.load("glDeleteProgram", calls.deleteProgram);
    if (auto complete = loader.result("shaders require OpenGL 2.0"); !complete) return complete.error();
    return calls;
}

} // namespace mural::native
