// Skips draw calls of frames that another node draws. They change no pixel here, and are skipped if they change nothing
// else either. The replay still decodes them and updates its own state; only the GL functions have no effect.
#include <tuple>
#include <utility>

#include "gl_opcodes.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/command_traits.hpp"

namespace mural {

namespace {

constexpr auto kDraws = std::tuple(
#include "skippable_draws.inc"
#include "streamcodec/wire/control_records.hpp"
);

template <class... A> void makeIneffective(void (*&function)(A...)) {
    if (function) function = [](A...) {};
}

template <class Call> void forEachDraw(Call&& call) {
    std::apply([&](auto... members) { (call(members), ...); }, kDraws);
}

} // namespace

// Returns whether any stage has storage blocks, counters or images. Pipelines are not inspected.
bool Replay::mayWriteMemory(GLuint program) {
    const bool can = c_->version >= (c_->api == wire::Api::Desktop ? 42 : 31);
    if (!can || program == 0) return c_->pipelineBound;
    const auto known = c_->shared->memoryWriters.find(program);
    if (known != c_->shared->memoryWriters.end()) return known->second;
    bool writes = !gl.glGetProgramInterfaceiv || !gl.glGetActiveUniformsiv;
    const GLuint nodeName = name(Kind::Program, program);
    for (const GLenum kind : {GL_SHADER_STORAGE_BLOCK, GL_ATOMIC_COUNTER_BUFFER}) {
        GLint count = 0;
        if (!writes) gl.glGetProgramInterfaceiv(nodeName, kind, GL_ACTIVE_RESOURCES, &count);
        writes = writes || count > 0;
    }
    GLint uniforms = 0;
    if (!writes) gl.glGetProgramiv(nodeName, GL_ACTIVE_UNIFORMS, &uniforms);
    for (GLuint i = 0; i < static_cast<GLuint>(uniforms) && !writes; ++i) {
        GLint type = 0;
        gl.glGetActiveUniformsiv(nodeName, 1, &i, GL_UNIFORM_TYPE, &type);
        writes = type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
    }
    return c_->shared->memoryWriters[program] = writes;
}

bool Replay::shouldSkipDraw(uint16_t opcode) {
    if (!hasTrait(opcode, Trait::SkippableDraw) || !drawsWindow() || !c_->draw || c_->compiling || !c_->shared)
        return false;
    const Window& w = *c_->draw;
    const bool drawsHere = isReplicatedDraw() || !w.drawn.empty() || w.whole.empty();
    return !drawsHere && c_->openQueries.empty() && !c_->feedsBack && !stipplesLines() && !mayWriteMemory(c_->program);
}

// Mesa carries the phase of a line stipple from draw to draw. A strip whose first segment is clipped away continues at
// the end of the last stippled line. Every node therefore executes all stippled draws, whole and in order.
bool Replay::stipplesLines() const {
    return c_->lineStippled && c_->api == wire::Api::Desktop && !c_->core &&
           gl.glIsEnabled(GL_LINE_STIPPLE) != GL_FALSE;
}

// Exchanges GL's draw functions with functions that have no effect. A second call restores them.
void Replay::swapDrawEntryPoints() {
    if (!ineffectiveDraws_) {
        ineffectiveDraws_ = std::make_unique<GlFunctions>(gl);
        forEachDraw([&](auto member) { makeIneffective((*ineffectiveDraws_).*member); });
    }
    forEachDraw([&](auto member) { std::swap(gl.*member, (*ineffectiveDraws_).*member); });
}

} // namespace mural
