// Fragment shaders that write to memory (atomic counters, shader storage, images): what they leave there
// must come from all fragments of the picture, on every node. Their draws are not cut to the tile.
#include <utility>

#include "nodes/replay/replay.hpp"

namespace mural {

namespace {

bool isImage(GLint type) { return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY; }

// True when a resource of that kind that the fragment shader uses passes `wanted` (its GL_TYPE, where it has one).
template <class Wanted> bool fragmentUses(const GlFunctions& gl, GLuint program, GLenum kind, bool hasType, Wanted&& wanted) {
    GLint count = 0;
    gl.glGetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
    for (GLint i = 0; i < count; ++i) {
        const GLenum names[2] = {GL_REFERENCED_BY_FRAGMENT_SHADER, GL_TYPE};
        GLint values[2] = {};
        gl.glGetProgramResourceiv(program, kind, static_cast<GLuint>(i), hasType ? 2 : 1, names, 2, nullptr, values);
        if (values[0] && wanted(values[1])) return true;
    }
    return false;
}

} // namespace

bool Replay::writesMemory(GLuint ours) {
    const bool may = c_->api == wire::Api::Desktop ? c_->version >= 42 : c_->version >= 31;
    if (ours == 0 || !may || !c_->shared || !gl.glGetProgramInterfaceiv || !gl.glGetProgramResourceiv) return false;
    const auto known = c_->shared->memoryWriters.find(ours);
    if (known != c_->shared->memoryWriters.end()) return known->second;
    GLint linked = 0;
    gl.glGetProgramiv(ours, GL_LINK_STATUS, &linked);
    const auto any = [](GLint) { return true; };
    const bool writes = linked && (fragmentUses(gl, ours, GL_ATOMIC_COUNTER_BUFFER, false, any) || fragmentUses(gl, ours, GL_SHADER_STORAGE_BLOCK, false, any) ||
                                   fragmentUses(gl, ours, GL_UNIFORM, true, isImage));
    return c_->shared->memoryWriters[ours] = writes;
}

void Replay::programLinked(GLuint ours) {
    if (c_->shared) c_->shared->memoryWriters.erase(ours);
    programChanged();
}

// The current program, or the pipeline's fragment stage, is another one.
void Replay::programChanged() {
    GLint fragment = 0;
    if (c_->program) {
        fragment = static_cast<GLint>(name(Kind::Program, c_->program));
    } else if (gl.glGetProgramPipelineiv && bound_ && (c_->api != wire::Api::Desktop ? c_->version >= 31 : c_->version >= 41)) {
        GLint pipeline = 0;
        gl.glGetIntegerv(GL_PROGRAM_PIPELINE_BINDING, &pipeline);
        if (pipeline) gl.glGetProgramPipelineiv(static_cast<GLuint>(pipeline), GL_FRAGMENT_SHADER, &fragment);
    }
    const bool writes = writesMemory(static_cast<GLuint>(fragment));
    if (writes == std::exchange(c_->memoryWritten, writes)) return;
    applyScissors();
    drawnWhole_ = drawnWhole_ || writes;
}

} // namespace mural
