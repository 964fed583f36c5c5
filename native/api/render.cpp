#include <mural/render.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "native/runtime/current_gl.hpp"
#include "native/runtime/task_state.hpp"

namespace mural {

namespace {

GLuint compile(const native::ShaderCalls& gl, GLenum stage, std::string_view text, std::string& problem) {
    const GLuint shader = gl.createShader(stage);
    const char* const begin = text.data();
    const auto length = static_cast<GLint>(text.size());
    gl.shaderSource(shader, 1, &begin, &length);
    gl.compileShader(shader);
    GLint ok = GL_FALSE, logBytes = 0;
    gl.getShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    gl.getShaderiv(shader, GL_INFO_LOG_LENGTH, &logBytes);
    std::string log(static_cast<size_t>(std::max(logBytes, 1)), '\0');
    gl.getShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &logBytes, log.data());
    log.resize(static_cast<size_t>(std::max(logBytes, 0)));
    problem = (stage == GL_VERTEX_SHADER ? "the vertex shader" : "the fragment shader") +
              std::string(" does not compile: ") + log;
    gl.deleteShader(shader);
    return 0;
}

// A colour that differs between neighbouring nodes.
std::array<float, 3> colourOf(int node) {
    constexpr double kGoldenRatio = 0.618033988749895;
    const double hue = std::fmod(node * kGoldenRatio, 1.0) * 6.283185307179586;
    const auto channel = [&](double shift) { return static_cast<float>(0.5 + 0.5 * std::cos(hue + shift)); };
    return {channel(0), channel(2.1), channel(4.2)};
}

} // namespace

// ---- RenderTask

const RenderContext& RenderTask::context() const { return state_.part.context; }
const Frame& RenderTask::frame() const { return state_.frame; }

void RenderTask::setNearFar(double nearPlane, double farPlane) {
    if (!(nearPlane > 0) || !(farPlane > nearPlane) || !std::isfinite(farPlane)) return;
    state_.view.nearPlane = nearPlane;
    state_.view.farPlane = farPlane;
}

Matrix4 RenderTask::projection() const { return projectionOf(state_.view); }
Matrix4 RenderTask::toEye() const { return toEyeOf(state_.view); }
Frustum RenderTask::cullFrustum() const { return frustumOf(state_.view, state_.part.scissor); }
void RenderTask::apply() const { state_.apply(); }
unsigned RenderTask::framebuffer() const { return state_.target.framebuffer(); }
bool RenderTask::sameAsBefore() const { return state_.sameAsBefore; }
ObjectReader& RenderTask::objects() const { return state_.objects.reader(); }
std::shared_ptr<AnyQueueReader> RenderTask::queueAny(std::string_view name) const { return state_.objects.queue(name); }
Barrier RenderTask::barrier(std::string_view name) const { return state_.objects.barrier(name); }

const void* RenderTask::keep(std::shared_ptr<const void> snapshot) const {
    state_.snapshots.push_back(std::move(snapshot));
    return state_.snapshots.back().get();
}
void RenderTask::reportMissing(const std::string& problem) const { state_.report(problem); }

// ---- Renderer

void Renderer::clear(RenderTask& task) {
    task.apply();
    const native::GlCalls& gl = native::currentGl();
    using DepthTest = Composition::DepthTest;
    const DepthTest test = composition().depthTest;
    const bool isReversed = test == DepthTest::Greater || test == DepthTest::GreaterOrEqual;
    gl.depthMask(GL_TRUE);
    gl.stencilMask(~0U);
    gl.clearColor(0, 0, 0, 0);
    gl.clearDepth(isReversed ? 0 : 1);
    gl.clearStencil(0);
    gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

void Renderer::draw(RenderTask& task) {
    constexpr int32_t kBorder = 4;
    task.apply();
    const native::GlCalls& gl = native::currentGl();
    const RenderContext& c = task.context();
    const auto colour = colourOf(c.node);
    const auto fill = [&](const PixelViewport& box, float brightness) {
        const PixelViewport inside = intersect(box, c.area);
        gl.scissor(inside.x, inside.y, inside.w, inside.h);
        gl.clearColor(colour[0] * brightness, colour[1] * brightness, colour[2] * brightness, 1);
        gl.clear(GL_COLOR_BUFFER_BIT);
    };
    fill(c.area, 1);
    fill({c.area.x + kBorder, c.area.y + kBorder, c.area.w - 2 * kBorder, c.area.h - 2 * kBorder}, 0.25F);
    gl.clearColor(0, 0, 0, 0);
}

// ---- functions

Result<unsigned> linkProgram(std::string_view vertex, std::string_view fragment) {
    auto calls = native::ShaderCalls::load();
    if (!calls) return calls.error();
    const native::ShaderCalls& gl = *calls;
    std::string problem;
    const GLuint first = compile(gl, GL_VERTEX_SHADER, vertex, problem);
    const GLuint second = first ? compile(gl, GL_FRAGMENT_SHADER, fragment, problem) : 0;
    if (!second) {
        if (first) gl.deleteShader(first);
        return Error{problem};
    }
    const GLuint program = gl.createProgram();
    gl.attachShader(program, first);
    gl.attachShader(program, second);
    gl.linkProgram(program);
    gl.deleteShader(first);
    gl.deleteShader(second);
    GLint ok = GL_FALSE, logBytes = 0;
    gl.getProgramiv(program, GL_LINK_STATUS, &ok);
    if (ok) return program;
    gl.getProgramiv(program, GL_INFO_LOG_LENGTH, &logBytes);
    std::string log(static_cast<size_t>(std::max(logBytes, 1)), '\0');
    gl.getProgramInfoLog(program, static_cast<GLsizei>(log.size()), &logBytes, log.data());
    log.resize(static_cast<size_t>(std::max(logBytes, 0)));
    gl.deleteProgram(program);
    return Error{"the program does not link: " + log};
}

std::array<float, 16> glMatrix(const Matrix4& matrix) {
    std::array<float, 16> columns{};
    for (size_t r = 0; r < 4; ++r)
        for (size_t c = 0; c < 4; ++c) columns[4 * c + r] = static_cast<float>(matrix.m[r][c]);
    return columns;
}

void (*glProc(const char* name))() { return native::currentGlProc(name); }

// The corners are all beyond one plane of the frustum.
bool isOutside(const Frustum& f, const Matrix4& toEye, const Vector3& lowest, const Vector3& highest) {
    int beyond[6] = {};
    for (int corner = 0; corner < 8; ++corner) {
        const Vector3 p = transformPoint(toEye, {corner & 1 ? highest.x : lowest.x, corner & 2 ? highest.y : lowest.y,
                                                 corner & 4 ? highest.z : lowest.z});
        const double depth = -p.z, n = f.nearPlane;
        beyond[0] += p.x * n < f.left * depth;
        beyond[1] += p.x * n > f.right * depth;
        beyond[2] += p.y * n < f.bottom * depth;
        beyond[3] += p.y * n > f.top * depth;
        beyond[4] += depth < n;
        beyond[5] += depth > f.farPlane;
    }
    return std::ranges::any_of(beyond, [](int count) { return count == 8; });
}

} // namespace mural
