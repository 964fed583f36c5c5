#include "native/runtime/current_gl.hpp"

#include <string>
#include <type_traits>

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
    std::string missing;
    const auto load = [&](const char* name, auto& call) {
        call = reinterpret_cast<std::remove_reference_t<decltype(call)>>(currentGlProc(name));
        if (!call && missing.empty()) missing = name;
    };
    load("glCreateShader", calls.createShader);
    load("glShaderSource", calls.shaderSource);
    load("glCompileShader", calls.compileShader);
    load("glGetShaderiv", calls.getShaderiv);
    load("glGetShaderInfoLog", calls.getShaderInfoLog);
    load("glDeleteShader", calls.deleteShader);
    load("glCreateProgram", calls.createProgram);
    load("glAttachShader", calls.attachShader);
    load("glLinkProgram", calls.linkProgram);
    load("glGetProgramiv", calls.getProgramiv);
    load("glGetProgramInfoLog", calls.getProgramInfoLog);
    load("glDeleteProgram", calls.deleteProgram);
    if (!missing.empty()) return Error{"the GL driver lacks " + missing + "; shaders require OpenGL 2.0"};
    return calls;
}

} // namespace mural::native
