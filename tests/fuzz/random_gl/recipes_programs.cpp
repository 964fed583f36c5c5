// Recipes for programs of the pool: creation, attributes, uniforms, pipelines, ARB programs, compute.
#include <cstring>

#include "tests/fuzz/random_gl/programs.hpp"
#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

char letter(const World& w) {
    return w.profile == Profile::Compat ? 'c'
           : w.profile == Profile::Core ? 'k'
           : w.profile == Profile::Es1  ? '1'
                                        : '3';
}

const PoolProgram& anyProgram(World& w) {
    for (;;) {
        const auto& pool = programPool();
        const PoolProgram& program = pool[w.random.below(static_cast<std::uint32_t>(pool.size()))];
        if (std::strchr(program.profiles, letter(w)) != nullptr) {
            return program;
        }
    }
}

bool hasVertexShader(GLuint program) {
    GLuint shaders[8] = {};
    GLsizei count = 0;
    glGetAttachedShaders(program, 8, &count, shaders);
    for (GLsizei i = 0; i < count; ++i) {
        GLint type = 0;
        glGetShaderiv(shaders[i], GL_SHADER_TYPE, &type);
        if (type == GL_VERTEX_SHADER) {
            return true;
        }
    }
    return false;
}

void feedUniforms(World& w, GLuint program) {
    const GLint color = GL(glGetUniformLocation, program, "tint");
    GL(glUniform4fv, color, 1, static_cast<const float*>(inputOf(Type::Float, w.random)));
    const GLint mode = GL(glGetUniformLocation, program, "mode");
    GL(glUniform1i, mode, w.random.between(0, 2));
    const GLint image = GL(glGetUniformLocation, program, "image");
    GL(glUniform1i, image, w.random.between(0, 2));
    const GLint offset = GL(glGetUniformLocation, program, "offset");
    GL(glUniform4f, offset, w.random.around(), w.random.around(), 0.0F, 0.0F);
    const GLint scale = GL(glGetUniformLocation, program, "scale");
    GL(glUniform1fv, scale, w.random.between(1, 4), static_cast<const float*>(inputOf(Type::Float, w.random)));
    const GLint deep = GL(glGetUniformLocation, program, w.random.chance(50) ? "deep" : "layers");
    GL(glUniform1i, deep, 3);
    if (!w.es()) {
        GL(glUniform2d, offset, 0.25, -0.5);
        GL(glUniform3ui, mode, 1U, 2U, w.random.below(9));
    }
}

GLuint build(World& w, const PoolProgram& chosen) {
    const GLuint program = GL(glCreateProgram);
    for (const Source& source : chosen.sources) {
        const GLuint shader = GL(glCreateShader, source.stage);
        const GLint length = static_cast<GLint>(std::strlen(source.text));
        GL(glShaderSource, shader, 1, &source.text, w.random.chance(50) ? nullptr : &length);
        GL(glCompileShader, shader);
        GL(glAttachShader, program, shader);
        if (w.random.chance(30)) {
            w.keep(Kind::Shader, shader);
        } else {
            GL(glDeleteShader, shader);
        }
    }
    GL(glBindAttribLocation, program, 0, "position");
    GL(glBindAttribLocation, program, 1, w.random.chance(70) ? "color" : "texCoord");
    GL(glBindAttribLocation, program, 2, w.random.chance(70) ? "texCoord" : "color");
    if (chosen.captured != nullptr && w.random.chance(70)) {
        const char* const names[] = {chosen.captured, "gl_Position"};
        GL(glTransformFeedbackVaryings, program, w.random.between(1, 2), names,
           w.random.chance(60) ? GL_INTERLEAVED_ATTRIBS : GL_SEPARATE_ATTRIBS);
    }
    if (w.random.chance(15)) {
        GL(glProgramParameteri, program, GL_PROGRAM_SEPARABLE, GL_TRUE);
    }
    GL(glLinkProgram, program);
    GLint linked = 0;
    GL(glGetProgramiv, program, GL_LINK_STATUS, &linked);
    w.observe(static_cast<std::uint64_t>(linked));
    w.slot(Kind::Program, w.programs++ % kSlots) = program;
    return program;
}

void buildAndUse(World& w) {
    const GLuint program = build(w, anyProgram(w));
    GL(glUseProgram, program);
    feedUniforms(w, program);
}

void bindBlocks(World& w) {
    const GLuint buffer = w.living(Kind::Buffer);
    const GLuint program = w.living(Kind::Program);
    GL(glBindBufferBase, GL_UNIFORM_BUFFER, w.random.below(3), buffer);
    GL(glUniformBlockBinding, program, 0, w.random.below(3));
    GL(glBindBufferRange, GL_SHADER_STORAGE_BUFFER, w.random.below(2), buffer, 0, w.random.between(16, 200) & ~3);
}

void dispatch(World& w) {
    for (const PoolProgram& candidate : programPool()) {
        if (candidate.sources[0].stage == GL_COMPUTE_SHADER && std::strchr(candidate.profiles, letter(w)) != nullptr) {
            GL(glUseProgram, build(w, candidate));
        }
    }
    GLuint buffer = w.living(Kind::Buffer);
    if (buffer == 0) {
        GL(glGenBuffers, 1, &buffer);
        w.keep(Kind::Buffer, buffer);
    }
    GL(glBindBufferBase, GL_SHADER_STORAGE_BUFFER, 0, buffer);
    GL(glBufferData, GL_SHADER_STORAGE_BUFFER, 256, inputOf(Type::Int, w.random), GL_DYNAMIC_COPY);
    GL(glDispatchCompute, w.random.between(1, 5), w.random.between(1, 2), 1);
    GL(glMemoryBarrier, GL_ALL_BARRIER_BITS);
    if (!w.es()) {
        void* const out = outputMemory(256);
        GL(glGetBufferSubData, GL_SHADER_STORAGE_BUFFER, 0, 256, out);
        w.observe(out, 256);
    }
}

// Draws with a program that counts its fragments.
void count(World& w) {
    GLuint buffer = 0;
    GL(glGenBuffers, 1, &buffer);
    w.keep(Kind::Buffer, buffer);
    const GLuint zeros[4] = {};
    GL(glBindBuffer, GL_SHADER_STORAGE_BUFFER, buffer);
    GL(glBufferData, GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(sizeof zeros), zeros, GL_DYNAMIC_COPY);
    GL(glBindBufferBase, GL_SHADER_STORAGE_BUFFER, 0, buffer);
    for (const PoolProgram& candidate : programPool()) {
        if (candidate.counts && std::strchr(candidate.profiles, letter(w)) != nullptr) {
            const GLuint program = build(w, candidate);
            GL(glUseProgram, program);
            feedUniforms(w, program);
        }
    }
    drawBuffered(w);
    if (!w.es()) {
        void* const out = outputMemory(sizeof zeros);
        GL(glGetBufferSubData, GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(sizeof zeros), out);
        w.observe(out, sizeof zeros);
        if (w.trace) {
            const auto* const counts = static_cast<const GLuint*>(out);
            traceText("counted",
                      shown(counts[0]) + " " + shown(counts[1]) + " " + shown(counts[2]) + " " + shown(counts[3]));
        }
    }
}

void pipeline(World& w) {
    GLuint pipeline = w.living(Kind::Pipeline);
    if (pipeline == 0) {
        GL(glGenProgramPipelines, 1, &pipeline);
        w.keep(Kind::Pipeline, pipeline);
    }
    const PoolProgram& chosen = anyProgram(w);
    for (const Source& source : chosen.sources) {
        const GLuint program = GL(glCreateShaderProgramv, source.stage, 1, &source.text);
        GLbitfield stage = GL_FRAGMENT_SHADER_BIT;
        stage = source.stage == GL_VERTEX_SHADER ? GL_VERTEX_SHADER_BIT : stage;
        stage = source.stage == GL_GEOMETRY_SHADER ? GL_GEOMETRY_SHADER_BIT : stage;
        GL(glUseProgramStages, pipeline, stage, program);
        w.slot(Kind::Program, w.programs++ % kSlots) = program;
    }
    GL(glUseProgram, 0);
    GL(glBindProgramPipeline, pipeline);
    GL(glValidateProgramPipeline, pipeline);
}

void arbProgram(World& w) {
    const std::uint32_t which = w.random.below(5);
    const GLenum target = which < 2 ? GL_VERTEX_PROGRAM_ARB : GL_FRAGMENT_PROGRAM_ARB;
    GLuint program = 0;
    GL(glGenProgramsARB, 1, &program);
    w.keep(Kind::ArbProgram, program);
    GL(glBindProgramARB, target, program);
    const char* const source = arbPrograms()[which];
    GL(glProgramStringARB, target, GL_PROGRAM_FORMAT_ASCII_ARB, static_cast<GLsizei>(std::strlen(source)), source);
    GL(glEnable, target);
    for (GLuint i = 0; i < 3; ++i) {
        GL(glProgramEnvParameter4fARB, target, i, w.random.around(), w.random.unit(), w.random.unit(), 1.0F);
        GL(glProgramLocalParameter4fARB, target, i, w.random.unit(), w.random.unit(), w.random.unit(), 1.0F);
    }
}

constexpr Recipe kRecipes[] = {
    {"program", buildAndUse, "ck3", 8}, {"use program", useAnyProgram, "ck3", 6}, {"blocks", bindBlocks, "ck3", 4},
    {"dispatch", dispatch, "ck3", 2},   {"pipeline", pipeline, "ck3", 2},         {"ARB program", arbProgram, "c", 4},
    {"count", count, "ck", 2},
};

} // namespace

void useNoGeometryShader(World& w) {
    GLint current = 0;
    GLint pipeline = 0;
    GLint geometry = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &current);
    glGetIntegerv(GL_PROGRAM_PIPELINE_BINDING, &pipeline);
    if (current != 0) {
        (void)w.failed();
        glGetProgramiv(static_cast<GLuint>(current), GL_GEOMETRY_VERTICES_OUT, &geometry);
        if (glGetError() == GL_NO_ERROR) { // an error without a geometry shader
            GL(glUseProgram, 0U);
        }
    }
    geometry = 0;
    if (pipeline != 0) {
        glGetProgramPipelineiv(static_cast<GLuint>(pipeline), GL_GEOMETRY_SHADER, &geometry);
    }
    if (geometry != 0) {
        GL(glBindProgramPipeline, 0U);
    }
}

bool drawsAnything(World& w) {
    if (!w.shaders() || w.profile == Profile::Compat) {
        return true;
    }
    GLint current = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &current);
    if (current != 0) {
        return hasVertexShader(static_cast<GLuint>(current));
    }
    GLint pipeline = 0;
    GLint vertexProgram = 0;
    glGetIntegerv(GL_PROGRAM_PIPELINE_BINDING, &pipeline);
    if (pipeline != 0) {
        glGetProgramPipelineiv(static_cast<GLuint>(pipeline), GL_VERTEX_SHADER, &vertexProgram);
    }
    return vertexProgram != 0;
}

void useAnyProgram(World& w) {
    const GLuint program = w.living(Kind::Program);
    if (program == 0) {
        buildAndUse(w);
        return;
    }
    GL(glUseProgram, program);
    feedUniforms(w, program);
}

std::span<const Recipe> programRecipes() { return kRecipes; }

} // namespace fuzz
