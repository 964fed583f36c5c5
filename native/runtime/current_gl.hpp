// The GL of the renderer that runs in the calling thread.
#pragma once

#include "common/base/result.hpp"
#include "native/runtime/gl_calls.hpp"
#include "native/runtime/gl_target.hpp"

namespace mural::native {

// Set by the player's thread while the renderer exists.
void setCurrentTarget(GlTarget* target);
// Requires a current target.
[[nodiscard]] const GlCalls& currentGl();
// Null without a current target, or for an unknown command.
[[nodiscard]] gl::Proc currentGlProc(const char* name);

// Commands of linkProgram().
struct ShaderCalls {
    PFNGLCREATESHADERPROC createShader = nullptr;
    PFNGLSHADERSOURCEPROC shaderSource = nullptr;
    PFNGLCOMPILESHADERPROC compileShader = nullptr;
    PFNGLGETSHADERIVPROC getShaderiv = nullptr;
    PFNGLGETSHADERINFOLOGPROC getShaderInfoLog = nullptr;
    PFNGLDELETESHADERPROC deleteShader = nullptr;
    PFNGLCREATEPROGRAMPROC createProgram = nullptr;
    PFNGLATTACHSHADERPROC attachShader = nullptr;
    PFNGLLINKPROGRAMPROC linkProgram = nullptr;
    PFNGLGETPROGRAMIVPROC getProgramiv = nullptr;
    PFNGLGETPROGRAMINFOLOGPROC getProgramInfoLog = nullptr;
    PFNGLDELETEPROGRAMPROC deleteProgram = nullptr;

    // Errors: no renderer runs in this thread; the driver lacks shaders.
    static Result<ShaderCalls> load();
};

} // namespace mural::native
