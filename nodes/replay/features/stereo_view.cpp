// Draws the picture for another eye than the program's, or for a screen at another place in the room. Positions are
// transformed in clip coordinates (clip_transform.hpp).
//
// Shaders receive the transformation as uniforms (nodes/shaders/moved_position). The program's view of its scene is
// derived from the matrices that it passes to its shaders (projection_detection.hpp). For shaders without matrices the
// fixed function's are assumed. The fixed function draws with a projection that the replay sets temporarily. Source:
// thesis, "Stereo Rendering"; docs/architecture/passes.md.
#include <algorithm>
#include <string_view>
#include <utility>

#include "gl_opcodes.hpp"
#include "nodes/replay/engine/command_uses.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/command_parameters.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

bool Replay::hasFixedMatrices() const {
    return c_->api != wire::Api::Es2 && !c_->core && gl.glLoadMatrixf && gl.glMatrixMode;
}
bool Replay::drawsFixed() const { return c_->program == 0 && !c_->pipelineBound && hasFixedMatrices(); }

// Returns the projection that a program's shaders use.
ProjectionDetector Replay::projectionOf(GLuint program) const {
    const auto own = c_->shared->projections.find(program);
    if (own != c_->shared->projections.end()) return own->second;
    if (c_->fixedProjection.perspective()) return c_->fixedProjection;
    if (c_->shared->projection.perspective()) return c_->shared->projection;
    // Without any known matrix a vertical field of view of 60 degrees is assumed.
    const auto& v = c_->viewports[0];
    constexpr double kScale = 1.7320508;
    return {kScale * static_cast<double>(std::max(1.0F, v[3]) / std::max(1.0F, v[2])), kScale, 0, 0, 1, 1};
}

// Screens of a room show draws that cover the whole picture. A part with a viewport of its own keeps its place.
ClipTransform Replay::viewMove(const ProjectionDetector& seen) const {
    if (!config_.screen && c_->draw->config.stereo) return {}; // the program draws both eyes itself
    if (!config_.screen) return eyeMove(seen, eyeOffset(), config_.focusDistance);
    const auto& v = c_->viewports[0];
    const PixelViewport& whole = c_->draw->whole;
    const bool all =
        v[0] == 0 && v[1] == 0 && v[2] == static_cast<GLfloat>(whole.w) && v[3] == static_cast<GLfloat>(whole.h);
    return all ? screenMove(seen, *config_.screen) : ClipTransform{};
}

void Replay::shiftProjection() {
    if (c_->projectionShifted) return;
    std::array<GLfloat, 16>& p = c_->onProjection;
    gl.glGetFloatv(GL_PROJECTION_MATRIX, p.data());
    double m[16];
    for (size_t i = 0; i < 16; ++i) m[i] = static_cast<double>(p[i]);
    const ProjectionDetector seen = seenProjection(m);
    if (!seen.perspective()) return; // identical from every position
    viewMove(seen).apply(m, seen.unit);
    for (size_t i = 0; i < 16; ++i) c_->shiftedProjection[i] = static_cast<GLfloat>(m[i]);
    GLint mode = 0;
    gl.glGetIntegerv(GL_MATRIX_MODE, &mode);
    gl.glMatrixMode(GL_PROJECTION);
    gl.glLoadMatrixf(c_->shiftedProjection.data());
    gl.glMatrixMode(static_cast<GLenum>(mode));
    c_->projectionShifted = true;
}

void Replay::unshiftProjection() {
    if (!c_->projectionShifted) return;
    c_->projectionShifted = false;
    GLint mode = 0;
    gl.glGetIntegerv(GL_MATRIX_MODE, &mode);
    gl.glMatrixMode(GL_PROJECTION);
    gl.glLoadMatrixf(c_->onProjection.data());
    gl.glMatrixMode(static_cast<GLenum>(mode));
}

// Called before draws with shaders that may read the fixed function's matrices.
void Replay::onFixedProjection() {
    if (c_->projectionKnown || !hasFixedMatrices()) return;
    c_->projectionKnown = true;
    GLfloat p[16];
    gl.glGetFloatv(GL_PROJECTION_MATRIX, p);
    const ProjectionDetector seen = seenProjection(p);
    if (c_->fixedProjection.isClose(seen)) return;
    c_->fixedProjection = seen;
    applyTileValues();
}

void Replay::onMatrices(GLuint program, const Data& values, GLsizei count, bool transposed, bool doubles) {
    const size_t bytes = doubles ? 128 : 64;
    if (!c_->shared || values.absent() || values.isOffset()) return;
    for (GLsizei i = 0; i < count && values.size() >= bytes * (static_cast<size_t>(i) + 1); ++i) {
        const std::byte* at = values.as<std::byte>() + bytes * static_cast<size_t>(i);
        const ProjectionDetector seen = seenProjectionAt(at, doubles, transposed);
        if (!seen.perspective()) continue;
        ProjectionDetector& known = c_->shared->projections[program];
        if (known.isClose(seen)) continue;
        known = seen;
        if (program == c_->program) applyTileValues();
    }
}

// Searches small buffers, which may be uniform blocks, for a projection.
void Replay::onProjections(std::span<const std::byte> bytes) {
    constexpr size_t kMaxBytes = 4096;
    if (!c_->shared || bytes.size() > kMaxBytes) return;
    const ProjectionDetector seen = lastProjectionIn(bytes);
    if (!seen.perspective()) return;
    if (c_->shared->projection.isClose(seen)) return;
    c_->shared->projection = seen;
    applyTileValues();
}

void Replay::onEye(uint16_t opcode, std::span<const std::byte> arguments) {
    const EyeUse use = eyeUseOf(opcode);
    if (use == EyeUse::None || !bound_ || c_->compiling) return;
    if (use == EyeUse::Framebuffer) c_->attachmentsKnown = false;
    if (use == EyeUse::Draw || use == EyeUse::List) onScene();
    if (!movesView()) return;
    if (use == EyeUse::Matrix) {
        c_->projectionKnown = false;
        return unshiftProjection();
    }
    if (use == EyeUse::Draw || use == EyeUse::List) {
        if (drawsFixed() && isSeen() && c_->draw) return shiftProjection();
        unshiftProjection();
        return onFixedProjection();
    }
    NoBlobs none;
    Args in(arguments, none);
    if (use == EyeUse::Buffer) return onProjections(arguments);
    if (use != EyeUse::Uniform) return;
    const std::span<const ParameterInfo> parameters = parametersOf(opcode).parameters;
    const bool named = std::string_view(parameters.front().name) == "program";
    const bool doubles = parameters.back().element == Element::F64;
    const GLuint program = named ? in.get<GLuint>() : c_->program;
    in.get<GLint>();
    const auto count = in.get<GLsizei>();
    const bool transposed = in.narrow<GLboolean>() != 0;
    const Data values = in.values();
    if (in.ok() && count > 0) onMatrices(program, values, count, transposed, doubles);
}

// A list may have set a projection of its own.
void Replay::onEyeAfter(uint16_t opcode) {
    if (eyeUseOf(opcode) != EyeUse::List || !bound_) return;
    c_->projectionKnown = false;
    if (!c_->projectionShifted) return;
    std::array<GLfloat, 16> now{};
    gl.glGetFloatv(GL_PROJECTION_MATRIX, now.data());
    if (now != c_->shiftedProjection) c_->projectionShifted = false;
}

} // namespace mural
