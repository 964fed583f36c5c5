// Programs with shaders rewritten for tiles (tiling.hpp), and the values of their added uniforms.
//
// The current program receives the values when it becomes current, and whenever viewport, framebuffer, window or
// maximum line width change. Draws in between have no overhead.
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "nodes/replay/engine/replay.hpp"
#include "nodes/shaders/frag_coord.hpp"
#include "nodes/shaders/spirv_module.hpp"

namespace mural {

ShaderRewrites Replay::rewrites() const {
    const bool moved = movesView() || (movesPicture() && movesByShaders());
    // Lookups with gradients may differ in the last bit. A zoom that changes must be exact at full resolution, so
    // texture levels follow the zoomed pixels.
    const bool gradients = drawsOtherPixels() && (hasKernel() || !config_.movesZoom);
    return {config_.cull && !alone() && !moved, (config_.lean && !alone()) || drawsOtherPixels(), drawsOtherPixels(),
            gradients, moved};
}

void Replay::applyTileValues() {
    if (!bound_ || !c_->shared || c_->compiling || (!c_->program && !c_->pipelineBound && !c_->arbPositions)) return;
    TileValues values;
    if (c_->draw && rewrites().any() && drawsWindow() && (!isReplicatedDraw() || drawsOtherPixels())) {
        TilePlace place;
        place.pass = passOfDraws();
        place.window = c_->draw->whole;
        place.tile = drawsLean() ? c_->draw->region : c_->draw->drawn;
        place.viewport = c_->viewports[0];
        place.marginPixels = c_->cullMargin;
        place.mayCull = config_.cull && !isReplicatedDraw() && !c_->lineStippled && !c_->clippingCounted;
        place.translated = drawsLean();
        values = tileValues(place);
    }
    if (rewrites().moved && isSeen() && c_->draw) values.move = moveOf(c_->program);
    if (c_->program)
        c_->shared->tiled.apply(gl, name(Kind::Program, c_->program), values);
    else if (c_->pipelineBound)
        c_->shared->tiled.applySeparable(gl, values);
    if (!c_->arbPositions) return;
    GLint count = 0;
    gl.glGetProgramivARB(GL_FRAGMENT_PROGRAM_ARB, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, &count);
    gl.glProgramEnvParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB, static_cast<GLuint>(count - 1), values.place.data());
    gl.glProgramEnvParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB, static_cast<GLuint>(count - 2), values.place.data() + 4);
}

// ---- shaders and programs

void Replay::glCompileShader(GLuint shader) {
    const GLuint nodeName = name(Kind::Program, shader);
    compileShader(nodeName);
    if (c_->shared) c_->shared->recipes.compiled(gl, nodeName, false);
}
void Replay::compileShader(GLuint nodeName) {
    if (c_->shared && rewrites().any())
        c_->shared->tiled.compile(gl, nodeName);
    else
        gl.glCompileShader(nodeName);
}
// Modules are not rewritten. If they need window coordinates, the whole window is drawn.
void Replay::glShaderBinary(GLsizei count, const Data& shaders, GLenum format, const Data& binary, GLsizei length) {
    if (!gl.glShaderBinary || !c_->shared || count < 0 || length < 0 ||
        shaders.size() < size_t{4} * static_cast<size_t>(count))
        return;
    std::vector<GLuint> nodeNames(static_cast<size_t>(count));
    const bool placed = shaders::moduleReadsFragCoord(binary.span());
    for (size_t i = 0; i < nodeNames.size(); ++i) {
        GLuint appName = 0;
        std::memcpy(&appName, shaders.as<std::byte>() + 4 * i, 4);
        nodeNames[i] = name(Kind::Program, appName);
        c_->shared->tiled.forget(nodeNames[i]);
        c_->shared->recipes.forget(nodeNames[i]);
        c_->shared->placedModules[nodeNames[i]] = placed;
    }
    gl.glShaderBinary(count, nodeNames.data(), format, binary.pointer(), length);
}
void Replay::glSpecializeShader(GLuint shader, const Data& entryPoint, GLuint count, const Data& indices,
                                const Data& values) {
    if (!gl.glSpecializeShader || indices.size() < size_t{4} * count || values.size() < size_t{4} * count) return;
    gl.glSpecializeShader(name(Kind::Program, shader), entryPoint.as<GLchar>(), count, indices.as<GLuint>(),
                          values.as<GLuint>());
}
void Replay::onModules(GLuint nodeName) {
    if (!c_->shared || !rewrites().windowCoordinates || c_->shared->placedModules.empty()) return;
    GLuint attached[16] = {};
    GLsizei count = 0;
    gl.glGetAttachedShaders(nodeName, 16, &count, attached);
    for (GLsizei i = 0; i < count; ++i) {
        const auto found = c_->shared->placedModules.find(attached[i]);
        if (found != c_->shared->placedModules.end() && found->second && !std::exchange(c_->shared->allDrawn, true))
            restoreWindowState();
    }
}
// A rewritten text would lose these paths, so such shaders are not rewritten.
void Replay::glCompileShaderIncludeARB(GLuint shader, GLsizei count, const Data& path) {
    StringList paths;
    if (!gl.glCompileShaderIncludeARB || !paths.parse(path, count)) return;
    const GLuint nodeName = name(Kind::Program, shader);
    gl.glCompileShaderIncludeARB(nodeName, count, paths.pointers(), paths.lengths());
    if (!c_->shared) return;
    c_->shared->tiled.forget(nodeName);
    c_->shared->recipes.compiled(gl, nodeName, true);
}
void Replay::glProgramParameteri(GLuint program, GLenum pname, GLint value) {
    const GLuint nodeName = name(Kind::Program, program);
    if (!gl.glProgramParameteri) return;
    gl.glProgramParameteri(nodeName, pname, value);
    if (pname != GL_PROGRAM_SEPARABLE || !c_->shared) return;
    c_->shared->tiled.setSeparable(nodeName, value != 0);
    c_->shared->recipes.separable(nodeName, value != 0);
}
void Replay::glLinkProgram(GLuint program) {
    const GLuint nodeName = name(Kind::Program, program);
    linkProgram(nodeName);
    if (c_->shared) c_->shared->recipes.linked(gl, nodeName);
    onModules(nodeName);
    if (takesRanges()) recordPrimitiveIds(nodeName);
    applyTileValues(); // it may be the current program
}
void Replay::linkProgram(GLuint nodeName) {
    if (c_->shared) c_->shared->memoryWriters.clear();
    if (!c_->shared || !rewrites().any())
        gl.glLinkProgram(nodeName);
    else
        c_->shared->tiled.link(gl, nodeName, rewrites(), esContext());
}
void Replay::glCreateShaderProgramv(GLenum type, GLsizei count, const Data& strings, GLuint result) {
    StringList texts;
    if (!gl.glCreateShaderProgramv || !c_->shared || !texts.parse(strings, count) || texts.count() == 0) return;
    bindName(Kind::Program, result,
             c_->shared->tiled.create(gl, type, count, texts.pointers(), rewrites(), esContext()));
    const GLuint nodeName = name(Kind::Program, result);
    ProgramSources recipe;
    recipe.separable = true;
    recipe.shaders.push_back({type, texts.joined()});
    c_->shared->recipes.linkedFrom(nodeName, std::move(recipe));
    onModules(nodeName);
    applyTileValues();
}
void Replay::glUseProgram(GLuint program) {
    c_->program = program;
    gl.glUseProgram(name(Kind::Program, program));
    applyTileValues();
}
void Replay::glBindProgramPipeline(GLuint pipeline) {
    if (!gl.glBindProgramPipeline) return;
    gl.glBindProgramPipeline(name(Kind::Pipeline, pipeline));
    c_->pipelineBound = pipeline != 0;
    applyTileValues();
}
void Replay::glUseProgramStages(GLuint pipeline, GLbitfield stages, GLuint program) {
    if (!gl.glUseProgramStages) return;
    gl.glUseProgramStages(name(Kind::Pipeline, pipeline), stages, name(Kind::Program, program));
    applyTileValues();
}

void Replay::glProgramStringARB(GLenum target, GLenum format, GLsizei len, const Data& string) {
    if (!gl.glProgramStringARB || len < 0) return;
    const auto load = [&](GLsizei length, const void* text) {
        gl.glProgramStringARB(target, format, length, text);
        GLint at = -1;
        gl.glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &at);
        return at < 0;
    };
    if (target == GL_FRAGMENT_PROGRAM_ARB && rewrites().windowCoordinates && gl.glGetProgramivARB &&
        gl.glProgramEnvParameter4fvARB) {
        GLint count = 0;
        gl.glGetProgramivARB(target, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, &count);
        const auto text = shaders::withWindowOffsetArb({string.as<char>(), static_cast<size_t>(len)}, count - 1);
        if (text && load(static_cast<GLsizei>(text->size()), text->data())) {
            c_->arbPositions = true;
            return applyTileValues();
        }
    }
    load(len, string.pointer());
}

// ---- extent of a primitive's picture beyond its vertices

void Replay::widen(GLfloat pixels) {
    const GLfloat margin = pixels / 2 + 2;
    if (!(margin > c_->cullMargin)) return;
    c_->cullMargin = margin;
    applyTileValues();
}
void Replay::glLineWidth(GLfloat width) {
    gl.glLineWidth(width);
    widen(width);
}
void Replay::glPointSize(GLfloat size) {
    gl.glPointSize(size);
    widen(size);
}
void Replay::glLineWidthx(GLint width) {
    if (gl.glLineWidthx) gl.glLineWidthx(width);
    widen(static_cast<GLfloat>(width) / 65536);
}
void Replay::glLineWidthxOES(GLint width) {
    if (gl.glLineWidthxOES) gl.glLineWidthxOES(width);
    widen(static_cast<GLfloat>(width) / 65536);
}
void Replay::glPointSizex(GLint size) {
    if (gl.glPointSizex) gl.glPointSizex(size);
    widen(static_cast<GLfloat>(size) / 65536);
}
void Replay::glPointSizexOES(GLint size) {
    if (gl.glPointSizexOES) gl.glPointSizexOES(size);
    widen(static_cast<GLfloat>(size) / 65536);
}

} // namespace mural
