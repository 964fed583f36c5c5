#include "nodes/replay/features/culling_state.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "nodes/culling/vertex_boxes.hpp"
#include "nodes/gl/software_renderer.hpp"

namespace mural::replay {

namespace {

// Caps that decide positions. They are off unless a command enables them.
constexpr GLenum kCaps[] = {GL_VERTEX_PROGRAM_ARB, GL_PROGRAM_POINT_SIZE, GL_PRIMITIVE_RESTART,
                            GL_PRIMITIVE_RESTART_FIXED_INDEX};

uint32_t bitOfCap(GLenum cap) {
    const auto* const found = std::ranges::find(kCaps, cap);
    return found == std::end(kCaps) ? 0 : 1U << (found - std::begin(kCaps));
}

bool hasExtension(const GlFunctions& gl, std::string_view wanted, int version) {
    if (version >= 30 && gl.glGetStringi) {
        GLint count = 0;
        gl.glGetIntegerv(GL_NUM_EXTENSIONS, &count);
        for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
            const auto* const text = reinterpret_cast<const char*>(gl.glGetStringi(GL_EXTENSIONS, i));
            if (text && wanted == text) return true;
        }
        return false;
    }
    const auto* const text = reinterpret_cast<const char*>(gl.glGetString(GL_EXTENSIONS));
    return text && std::string_view(text).find(wanted) != std::string_view::npos;
}

GLint integer(const GlFunctions& gl, GLenum name) {
    GLint value[4] = {};
    gl.glGetIntegerv(name, value);
    return value[0];
}

GLint attributeValue(const GlFunctions& gl, GLuint index, GLenum name) {
    GLint value[4] = {};
    gl.glGetVertexAttribiv(index, name, value);
    return value[0];
}

uint64_t pointerOf(const GlFunctions& gl, GLuint index) {
    GLvoid* pointer = nullptr;
    gl.glGetVertexAttribPointerv(index, GL_VERTEX_ATTRIB_ARRAY_POINTER, &pointer);
    return reinterpret_cast<uintptr_t>(pointer);
}

// The stride of arrays that were set with stride 0.
void setTightStride(CullingArray& array) {
    if (array.stride > 0) return;
    culling::AttributeArray read;
    read.type = array.type;
    read.components = static_cast<uint32_t>(array.components);
    array.stride = culling::elementBytes(read);
}

double aliasedPointSize(const GlFunctions& gl) {
    GLfloat range[2] = {1, 1};
    gl.glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, range);
    return range[1];
}

// The size beyond which no point is drawn.
double largestPoint(const GlFunctions& gl, bool isCore) {
    GLfloat smooth[2] = {1, 1};
    gl.glGetFloatv(GL_POINT_SIZE_RANGE, smooth);
    return isCore ? smooth[1] : std::max<double>(aliasedPointSize(gl), smooth[1]);
}

// The largest size of points, whatever a shader or the distance makes of it.
double pointSizeOf(const GlFunctions& gl, bool isCore, bool byShader) {
    if (byShader) return largestPoint(gl, isCore);
    GLfloat size = 1, attenuation[3] = {1, 0, 0};
    gl.glGetFloatv(GL_POINT_SIZE, &size);
    if (isCore) return size;
    gl.glGetFloatv(GL_POINT_DISTANCE_ATTENUATION, attenuation);
    const bool isPlain = attenuation[0] == 1 && attenuation[1] == 0 && attenuation[2] == 0;
    return isPlain ? size : std::max<double>(size, largestPoint(gl, isCore));
}

// Pixels between the edge of the area and the planes: rounding of positions to subpixels, and drivers that draw a row
// of pixels beyond the scissor.
constexpr double kMarginPixels = 2;

} // namespace

double CullingState::RasterState::marginOf(GLenum mode) const {
    if (mode == GL_POINTS) return pointSize / 2 + kMarginPixels;
    if (mode >= GL_LINES && mode <= GL_LINE_STRIP) return lineWidth / 2 + kMarginPixels;
    if (drawsEdges) return std::max(pointSize, lineWidth) / 2 + kMarginPixels;
    return kMarginPixels;
}

uint64_t CullingGroup::contentsOf(GLuint buffer) {
    static uint64_t numbers = 0; // one thread replays all contexts
    const auto [it, isNew] = contents_.try_emplace(buffer, 0);
    if (isNew) it->second = ++numbers;
    return it->second;
}

void CullingGroup::capSeen(GLenum cap) { caps_ |= bitOfCap(cap); }
bool CullingGroup::hasSeen(GLenum cap) const { return (caps_ & bitOfCap(cap)) != 0; }

const CullingState::FixedMatrices& CullingState::matrices(const GlFunctions& gl) {
    if (!isDirty(Matrices)) return matrices_;
    ++matricesNumber_;
    if (isDirty(Projection)) gl.glGetFloatv(GL_PROJECTION_MATRIX, matrices_.projection);
    if (isDirty(Modelview)) gl.glGetFloatv(GL_MODELVIEW_MATRIX, matrices_.modelview);
    dirty_ &= ~unsigned{Matrices};
    return matrices_;
}

void CullingState::matrixChanged() {
    switch (matrixMode_) {
    case GL_MODELVIEW: dirty_ |= Modelview; break;
    case GL_PROJECTION: dirty_ |= Projection; break;
    case GL_TEXTURE: break;
    default: dirty_ |= Matrices; // unknown, or one of the matrices of extensions
    }
}

const CullingState::RasterState& CullingState::raster(const GlFunctions& gl, const CullingGroup& group) {
    if (!facts.areKnown) {
        facts.areKnown = true;
        const auto* const renderer = reinterpret_cast<const char*>(gl.glGetString(GL_RENDERER));
        facts.isSoftware = renderer && gl::drawsWithoutGpu(renderer);
        facts.hasBindings =
            facts.version >= (facts.isEs ? 31 : 43) || hasExtension(gl, "GL_ARB_vertex_attrib_binding", facts.version);
        facts.hasClipControl =
            facts.isEs
                ? hasExtension(gl, "GL_EXT_clip_control", facts.version)
                : gl.glClipControl && (facts.version >= 45 || hasExtension(gl, "GL_ARB_clip_control", facts.version));
    }
    if (!isDirty(Raster)) return raster_;
    dirty_ &= ~unsigned{Raster};
    ++rasterNumber_;
    const auto isOn = [&](GLenum cap) { return group.hasSeen(cap) && gl.glIsEnabled(cap); };
    GLfloat box[4] = {}, width = 1;
    gl.glGetFloatv(GL_VIEWPORT, box);
    gl.glGetFloatv(GL_LINE_WIDTH, &width);
    GLint modes[2] = {GL_FILL, GL_FILL};
    if (!facts.isEs) gl.glGetIntegerv(GL_POLYGON_MODE, modes);
    raster_.viewport = {box[0], box[1], box[2], box[3]};
    raster_.lineWidth = width;
    raster_.pointSize = facts.isEs ? aliasedPointSize(gl) : pointSizeOf(gl, facts.isCore, isOn(GL_PROGRAM_POINT_SIZE));
    raster_.drawsEdges = modes[0] != GL_FILL || (modes[1] != GL_FILL && !facts.isCore);
    raster_.isUpsideDown = facts.hasClipControl && integer(gl, GL_CLIP_ORIGIN) != GL_LOWER_LEFT;
    raster_.isArbProgram = isOn(GL_VERTEX_PROGRAM_ARB);
    raster_.restartsAtLargest = isOn(GL_PRIMITIVE_RESTART_FIXED_INDEX);
    raster_.restarts = !facts.isEs && isOn(GL_PRIMITIVE_RESTART);
    if (raster_.restarts) raster_.restartIndex = static_cast<GLuint>(integer(gl, GL_PRIMITIVE_RESTART_INDEX));
    return raster_;
}

void CullingState::selectVertexArray(const GlFunctions& gl) {
    if (isDirty(Arrays)) {
        layouts_.clear();
        layout_ = nullptr;
    }
    if (!layout_ || isDirty(VertexArray))
        layout_ = &layouts_[facts.version >= 30 ? static_cast<GLuint>(integer(gl, GL_VERTEX_ARRAY_BINDING)) : 0];
    dirty_ &= ~unsigned{Arrays | VertexArray};
}

const CullingArray& CullingState::position(const GlFunctions& gl) {
    selectVertexArray(gl);
    CullingArray& array = layout_->position;
    if (layout_->knowsPosition) return array;
    layout_->knowsPosition = true;
    array = {};
    array.isEnabled = gl.glIsEnabled(GL_VERTEX_ARRAY) != GL_FALSE;
    if (!array.isEnabled) return array;
    array.components = integer(gl, GL_VERTEX_ARRAY_SIZE);
    array.type = static_cast<GLenum>(integer(gl, GL_VERTEX_ARRAY_TYPE));
    array.stride = static_cast<uint64_t>(integer(gl, GL_VERTEX_ARRAY_STRIDE));
    array.buffer = static_cast<GLuint>(integer(gl, GL_VERTEX_ARRAY_BUFFER_BINDING));
    GLvoid* pointer = nullptr;
    gl.glGetPointerv(GL_VERTEX_ARRAY_POINTER, &pointer);
    array.offset = reinterpret_cast<uintptr_t>(pointer);
    setTightStride(array);
    return array;
}

const CullingArray& CullingState::attribute(const GlFunctions& gl, GLuint index) {
    selectVertexArray(gl);
    const auto [it, isNew] = layout_->attributes.try_emplace(index);
    CullingArray& array = it->second;
    if (!isNew) return array;
    array.isEnabled = attributeValue(gl, index, GL_VERTEX_ATTRIB_ARRAY_ENABLED) != 0;
    if (!array.isEnabled) return array;
    const auto value = [&](GLenum name) { return attributeValue(gl, index, name); };
    array.components = value(GL_VERTEX_ATTRIB_ARRAY_SIZE);
    array.type = static_cast<GLenum>(value(GL_VERTEX_ATTRIB_ARRAY_TYPE));
    array.isNormalized = value(GL_VERTEX_ATTRIB_ARRAY_NORMALIZED) != 0;
    array.isFloat = (facts.version < 30 || !value(GL_VERTEX_ATTRIB_ARRAY_INTEGER)) &&
                    (facts.version < 43 || !value(GL_VERTEX_ATTRIB_ARRAY_LONG));
    array.buffer = static_cast<GLuint>(value(GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING));
    if (facts.hasBindings) {
        const auto binding = static_cast<GLuint>(value(GL_VERTEX_ATTRIB_BINDING));
        GLint64 offset = 0;
        GLint stride = 0, divisor = 0;
        gl.glGetInteger64i_v(GL_VERTEX_BINDING_OFFSET, binding, &offset);
        gl.glGetIntegeri_v(GL_VERTEX_BINDING_STRIDE, binding, &stride);
        gl.glGetIntegeri_v(GL_VERTEX_BINDING_DIVISOR, binding, &divisor);
        array.offset = static_cast<uint64_t>(offset) + static_cast<uint64_t>(value(GL_VERTEX_ATTRIB_RELATIVE_OFFSET));
        array.stride = static_cast<uint64_t>(stride);
        array.divisor = static_cast<GLuint>(divisor);
        if (array.buffer == 0) array.offset = pointerOf(gl, index); // Mesa returns 32 bits of the binding's offset
        return array;
    }
    array.stride = static_cast<uint64_t>(value(GL_VERTEX_ATTRIB_ARRAY_STRIDE));
    if (gl.glVertexAttribDivisor) array.divisor = static_cast<GLuint>(value(GL_VERTEX_ATTRIB_ARRAY_DIVISOR));
    array.offset = pointerOf(gl, index);
    setTightStride(array);
    return array;
}

GLuint CullingState::indexBuffer(const GlFunctions& gl) {
    if (isDirty(IndexBuffer)) {
        indexBuffer_ = static_cast<GLuint>(integer(gl, GL_ELEMENT_ARRAY_BUFFER_BINDING));
        dirty_ &= ~unsigned{IndexBuffer};
    }
    return indexBuffer_;
}

} // namespace mural::replay
