// Positions of programs: their slices, the uniforms and attributes that these read.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/culling.hpp"

namespace mural {

namespace {

using culling::WhyWhole;

constexpr std::string_view kProjection = "gl_ProjectionMatrix", kModelview = "gl_ModelViewMatrix";
constexpr std::string_view kFixedPosition = "gl_Vertex";

// Names whose values depend on the number of draws or primitives before.
bool countsPrimitives(const std::string& text) {
    return text.find("gl_PrimitiveID") != std::string::npos || text.find("gl_DrawID") != std::string::npos;
}

// Whether GPUs may compute in less than 32 bits.
bool hasLowPrecision(const std::string& text) {
    return text.find("mediump") != std::string::npos || text.find("lowp") != std::string::npos;
}

} // namespace

// The slice of a linked program, made once after each change of programs.
replay::CullingProgram& Replay::cullingProgram(GLuint nodeName) {
    replay::CullingGroup& group = c_->shared->culling;
    if (std::exchange(group.knownLinks, group.links) != group.links) group.programs.clear();
    std::shared_ptr<replay::CullingProgram>& slot = group.programs[nodeName];
    if (slot) return *slot;
    slot = std::make_shared<replay::CullingProgram>();
    replay::CullingProgram& program = *slot;
    const ProgramSources* const sources = c_->shared->recipes.sourcesOf(nodeName);
    const std::string* text = nullptr;
    GLint isLinked = GL_FALSE;
    gl.glGetProgramiv(nodeName, GL_LINK_STATUS, &isLinked);
    if (!isLinked) {
        program.reason = "its last link failed";
    } else if (!sources || sources->separable || !sources->varyings.empty()) {
        program.reason = "its texts are unknown, or it captures vertices";
    } else {
        program.mayCut = true;
        for (const ProgramSources::Shader& shader : sources->shaders) {
            program.mayCut = program.mayCut && !countsPrimitives(shader.text);
            if (shader.type == GL_FRAGMENT_SHADER) continue;
            if (shader.type != GL_VERTEX_SHADER || text) program.reason = "it has several stages of vertices";
            text = &shader.text;
        }
        if (!text) program.reason = "it has no vertex shader";
        if (text && !cullingOf(*c_).state.facts.isSoftware && hasLowPrecision(*text))
            program.reason = "it computes in low precision";
    }
    if (program.reason.empty()) {
        culling::ShaderSlice slice = culling::sliceOf(*text, esContext());
        program.reason = slice.reason;
        if (slice.isUsable()) {
            program.view.emplace(std::move(slice));
            bindSlice(nodeName, program);
        }
    }
    if (!program.reason.empty()) {
        program.view.reset();
        log::debug(log::Topic::Replay, "culling: a program is drawn whole: ", program.reason);
    }
    return program;
}

// Finds the locations of the slice's uniforms and attributes.
void Replay::bindSlice(GLuint nodeName, replay::CullingProgram& program) {
    const culling::ShaderSlice& slice = program.view->slice();
    if (slice.inputs.size() > culling::kMaxInputs) {
        program.reason = "it reads too many attributes";
        return;
    }
    std::map<std::string, size_t> byName;
    for (size_t i = 0; i < slice.uniforms.size(); ++i) {
        const culling::SliceSource& source = slice.uniforms[i];
        const auto [it, isNew] = byName.try_emplace(source.name, program.uniforms.size());
        if (isNew) {
            replay::CullingProgram::Uniform uniform;
            uniform.isModelview = source.name == kModelview;
            const bool isFixed = uniform.isModelview || source.name == kProjection;
            if (!isFixed) uniform.location = gl.glGetUniformLocation(nodeName, source.name.c_str());
            if (!isFixed && uniform.location < 0) program.reason = "it has no uniform " + source.name;
            program.uniforms.push_back(std::move(uniform));
        }
        program.uniforms[it->second].components.push_back(source.component);
        program.uniforms[it->second].places.push_back(static_cast<uint32_t>(i));
    }
    for (const culling::SliceSource& source : slice.inputs) {
        const bool isFixed = source.name == kFixedPosition;
        const GLint location = isFixed ? -1 : gl.glGetAttribLocation(nodeName, source.name.c_str());
        if (!isFixed && location < 0) program.reason = "it has no attribute " + source.name;
        auto at = std::ranges::find(program.attributes, location);
        if (at == program.attributes.end()) at = program.attributes.insert(at, location);
        program.inputs.push_back({static_cast<size_t>(at - program.attributes.begin()), source.component});
    }
    if (slice.inputs.empty()) program.reason = "its position depends on no attribute";
}

// Values of the slice's uniforms, asked of GL.
std::vector<float> Replay::uniformsOf(GLuint nodeName, const replay::CullingProgram& program) {
    std::vector<float> values(program.view->slice().uniforms.size());
    for (const replay::CullingProgram::Uniform& uniform : program.uniforms) {
        GLfloat read[16];
        std::ranges::fill(read, NAN); // remains where GL returns nothing
        const GLfloat* from = read;
        if (uniform.location >= 0)
            gl.glGetUniformfv(nodeName, uniform.location, read);
        else if (!cullingOf(*c_).state.facts.hasMatrices)
            read[0] = NAN;
        else
            from = uniform.isModelview ? cullingOf(*c_).state.matrices(gl).modelview
                                       : cullingOf(*c_).state.matrices(gl).projection;
        for (size_t i = 0; i < uniform.components.size(); ++i)
            values[uniform.places[i]] = from[std::min<size_t>(uniform.components[i], 15)];
    }
    return values;
}

// The arrays that the position reads. Returns why they cannot be examined.
WhyWhole Replay::readArrays(const replay::CullingProgram* program, std::vector<replay::CullingArray>& arrays) {
    replay::CullingState& state = cullingOf(*c_).state;
    arrays.clear();
    size_t components = 0;
    const size_t count = program ? program->attributes.size() : 1;
    for (size_t i = 0; i < count; ++i) {
        const GLint location = program ? program->attributes[i] : -1;
        const bool isFixed = location < 0;
        // A generic array 0 replaces the position of fixed function.
        if (isFixed && gl.glGetVertexAttribiv && state.attribute(gl, 0).isEnabled) return WhyWhole::Attribute;
        const replay::CullingArray& array =
            isFixed ? state.position(gl) : state.attribute(gl, static_cast<GLuint>(location));
        if (!array.isEnabled || !array.isFloat || array.divisor != 0) return WhyWhole::Attribute;
        if (array.buffer && c_->shared->culling.isAmbiguous(array.buffer)) return WhyWhole::Attribute;
        if (array.components < 1 || array.components > 4) return WhyWhole::Attribute; // such as GL_BGRA
        components += static_cast<size_t>(array.components);
        arrays.push_back(array);
    }
    return components <= culling::kMaxInputs ? WhyWhole::None : WhyWhole::Attribute;
}

// The clip coordinates as functions of the components of `arrays`.
std::optional<culling::LinearView> Replay::linearView(GLuint nodeName, replay::CullingProgram* program,
                                                      std::span<const replay::CullingArray> arrays) {
    if (!program) {
        const auto& matrices = cullingOf(*c_).state.matrices(gl);
        return culling::fixedFunctionView(matrices.projection, matrices.modelview,
                                          static_cast<size_t>(arrays[0].components));
    }
    const auto view = program->view->viewFor(uniformsOf(nodeName, *program));
    if (!view) return std::nullopt;
    std::vector<size_t> starts; // first component of each array
    size_t total = 0;
    for (const replay::CullingArray& array : arrays) {
        starts.push_back(total);
        total += static_cast<size_t>(array.components);
    }
    const auto moved = [&](const culling::LinearForm& form) {
        culling::LinearForm out;
        out.constant = form.constant;
        out.constantError = form.constantError;
        for (size_t i = 0; i < program->inputs.size(); ++i) {
            const auto [attribute, component] = program->inputs[i];
            if (component < static_cast<uint32_t>(arrays[attribute].components)) {
                out.factor[starts[attribute] + component] = form.factor[i];
                out.error[starts[attribute] + component] = form.error[i];
            } else if (component == 3) { // missing components are 0, 0 and 1
                out.constant += form.factor[i];
                out.constantError += form.error[i];
            }
        }
        return out;
    };
    return culling::LinearView{total, moved(view->x), moved(view->y), moved(view->w)};
}

} // namespace mural
