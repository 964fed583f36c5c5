// The picture of another eye than the program's: a shift of positions by their depth, off-axis as two eyes see one
// screen. With eye distance e from the centre and distance of focus f, in eye coordinates x - e before the projection,
// and the frustum sheared so that what lies at f stays where it is: x_clip + K (w / f - 1), K = e times the
// projection's scale of x. No other coordinate changes, so depth tests decide as they did.
//
// Shaders get K by a uniform (nodes/shaders/moved_position), its scale from the matrices that the program hands to
// them: of any matrix that ends in a perspective one, the first row's length beside the fourth over the fourth's. Shaders
// that get none are taken to use the fixed function's. Fixed function gets a projection of its own while it draws.
// Source: thesis, "Stereo Rendering"; design 4.
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "gl_opcodes.hpp"
#include "nodes/replay/field_scale.hpp"
#include "nodes/replay/replay.hpp"
#include "streamcodec/opcode_names.hpp"

namespace mural {

namespace {

enum class EyeUse : uint8_t { None, Matrix, Draw, List, Uniform, Buffer, Framebuffer };

EyeUse classify(std::string_view name) {
    const auto starts = [&](std::string_view stem) { return name.starts_with(stem); };
    if (starts("glUniformMatrix4") || starts("glProgramUniformMatrix4")) return EyeUse::Uniform;
    for (const std::string_view stem : {"glBindFramebuffer", "glFramebuffer", "glNamedFramebuffer", "glDeleteFramebuffers", "glDeleteTextures", "glDeleteRenderbuffers"})
        if (starts(stem)) return EyeUse::Framebuffer;
    if (starts("glUniform") || starts("glProgramUniform")) return EyeUse::None;
    if (starts("glBufferData") || starts("glBufferSubData") || starts("glNamedBuffer") || starts("glBufferStorage")) return EyeUse::Buffer;
    for (const std::string_view stem : {"glRotate", "glTranslate", "glScale", "glFrustum", "glOrtho", "glLoadIdentity", "glLoadTranspose", "glMultTranspose", "glLoadMatrix", "glMultMatrix", "glPushMatrix", "glPopMatrix", "glMatrix"})
        if (starts(stem) && name != "glMatrixMode") return EyeUse::Matrix;
    if (starts("glCallList")) return EyeUse::List;
    if (starts("glDrawBuffer")) return EyeUse::None;
    for (const std::string_view stem : {"glDraw", "glMultiDraw", "glMultiMode", "glRect", "glEvalMesh", "glRasterPos"})
        if (starts(stem)) return EyeUse::Draw;
    return name == "glBegin" ? EyeUse::Draw : EyeUse::None;
}

EyeUse useOf(uint16_t opcode) {
    static const auto kUses = [] {
        std::vector<EyeUse> uses(op::kLimit, EyeUse::None);
        for (uint16_t o = wire::kFirstGlOpcode; o < op::kLimit; ++o)
            if (const char* name = glOpcodeName(o)) uses[o] = classify(name);
        return uses;
    }();
    return kUses[opcode];
}

class NoBlobs : public BlobQueue {
    std::span<const std::byte> takeBlob(bool& found) override {
        found = false;
        return {};
    }
};

} // namespace

bool Replay::hasFixedMatrices() const { return c_->api != wire::Api::Es2 && !c_->core && gl.glLoadMatrixf && gl.glMatrixMode; }
bool Replay::drawsFixed() const { return c_->program == 0 && !c_->pipelineBound && hasFixedMatrices(); }

void Replay::shiftProjection() {
    if (c_->projectionShifted) return;
    std::array<GLfloat, 16>& p = c_->ownProjection;
    gl.glGetFloatv(GL_PROJECTION_MATRIX, p.data());
    double m[16];
    for (size_t i = 0; i < 16; ++i) m[i] = static_cast<double>(p[i]);
    const double scale = fieldScaleOf(m);
    if (scale == 0) return; // no perspective: both eyes see the same
    const double w = std::sqrt(m[3] * m[3] + m[7] * m[7] + m[11] * m[11]);
    const double k = scale * w * eyeOffset();
    c_->shiftedProjection = p;
    for (size_t column = 0; column < 4; ++column)
        c_->shiftedProjection[4 * column] = static_cast<GLfloat>(m[4 * column] + k / (w * config_.focusDistance) * m[4 * column + 3] - (column == 3 ? k : 0));
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
    gl.glLoadMatrixf(c_->ownProjection.data());
    gl.glMatrixMode(static_cast<GLenum>(mode));
}

// Before shaders draw that may read the fixed function's matrices.
void Replay::noteFixedProjection() {
    if (c_->projectionKnown || !hasFixedMatrices()) return;
    c_->projectionKnown = true;
    GLfloat p[16];
    gl.glGetFloatv(GL_PROJECTION_MATRIX, p);
    const double scale = fieldScaleOf(p);
    if (std::exchange(c_->fixedScale, scale) != scale) applyTileValues();
}

void Replay::noteMatrices(GLuint program, const Data& values, GLsizei count, bool transposed, bool doubles) {
    const size_t bytes = doubles ? 128 : 64;
    if (!c_->shared || values.absent() || values.isOffset()) return;
    for (GLsizei i = 0; i < count && values.size() >= bytes * (static_cast<size_t>(i) + 1); ++i) {
        const std::byte* at = values.as<std::byte>() + bytes * static_cast<size_t>(i);
        const double scale = fieldScaleAt(at, doubles, transposed);
        if (scale == 0) continue;
        double& known = c_->shared->fieldScales[program];
        const bool changed = std::fabs(known - scale) > 1e-4 * scale;
        known = scale;
        if (changed && program == c_->program) applyTileValues();
    }
}

// Blocks of uniforms: small buffers are looked through for a projection.
void Replay::noteProjections(std::span<const std::byte> bytes) {
    constexpr size_t kMostBytes = 4096;
    if (!c_->shared || bytes.size() > kMostBytes) return;
    const double scale = lastProjectionIn(bytes);
    if (scale == 0) return;
    const bool changed = std::fabs(c_->shared->fieldScale - scale) > 1e-4 * scale;
    c_->shared->fieldScale = scale;
    if (changed) applyTileValues();
}

void Replay::noteEye(uint16_t opcode, std::span<const std::byte> arguments) {
    const EyeUse use = useOf(opcode);
    if (use == EyeUse::None || !bound_ || c_->compiling) return;
    if (use == EyeUse::Framebuffer) c_->attachmentsKnown = false;
    if (use == EyeUse::Draw || use == EyeUse::List) noteScene();
    if (!seesWithOtherEye()) return;
    if (use == EyeUse::Matrix) {
        c_->projectionKnown = false;
        return unshiftProjection();
    }
    if (use == EyeUse::Draw || use == EyeUse::List) {
        if (drawsFixed() && isSeen() && c_->draw) return shiftProjection();
        unshiftProjection();
        return noteFixedProjection();
    }
    NoBlobs none;
    Args in(arguments, none);
    if (use == EyeUse::Buffer) return noteProjections(arguments);
    if (use != EyeUse::Uniform) return;
    const std::string_view name = glOpcodeName(opcode);
    const bool named = name.starts_with("glProgram");
    if (name.find("4x") != std::string_view::npos) return; // not square
    const GLuint program = named ? in.get<GLuint>() : c_->program;
    in.get<GLint>();
    const auto count = in.get<GLsizei>();
    const bool transposed = in.narrow<GLboolean>() != 0;
    const Data values = in.values();
    if (in.ok() && count > 0) noteMatrices(program, values, count, transposed, name.find("dv") != std::string_view::npos);
}

// A list may have brought a projection of its own.
void Replay::noteEyeAfter(uint16_t opcode) {
    if (useOf(opcode) != EyeUse::List || !bound_) return;
    c_->projectionKnown = false;
    if (!c_->projectionShifted) return;
    std::array<GLfloat, 16> now{};
    gl.glGetFloatv(GL_PROJECTION_MATRIX, now.data());
    if (now != c_->shiftedProjection) c_->projectionShifted = false;
}

} // namespace mural
