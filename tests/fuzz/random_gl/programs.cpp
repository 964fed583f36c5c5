#include "tests/fuzz/random_gl/programs.hpp"

namespace fuzz {
namespace {

constexpr const char* kOldVertex = R"(#version 120
attribute vec4 position; attribute vec4 color; attribute vec2 texCoord;
uniform vec4 offset; uniform mat4 matrix; uniform int mode;
varying vec4 varied; varying vec2 coord;
void main() {
    varied = color + gl_Color * 0.5;
    coord = texCoord + gl_MultiTexCoord0.xy;
    vec4 p = vec4(position.xyz + offset.xyz * 0.3, 1.0);
    gl_Position = mode == 1 ? gl_ModelViewProjectionMatrix * p : p + matrix * p * 0.1;
    gl_PointSize = 3.0;
})";
constexpr const char* kOldFragment = R"(#version 120
uniform vec4 tint; uniform sampler2D image; uniform float scale[3];
varying vec4 varied; varying vec2 coord;
void main() {
    gl_FragColor = varied * 0.5 + tint * 0.5 + texture2D(image, coord) * 0.25 + vec4(scale[1] * 0.01);
})";
constexpr const char* kFrontFragment = R"(#version 120
uniform vec4 tint;
void main() {
    vec2 at = fract(gl_FragCoord.xy * 0.11);
    gl_FragColor = gl_FrontFacing ? vec4(at, 0.4, 0.7) : tint + vec4(0.0, at.yx, 0.5);
    gl_FragDepth = gl_FragCoord.z * 0.5 + at.x * 0.2;
})";
constexpr const char* kCoreVertex = R"(#version 150
in vec4 position; in vec4 color; in vec2 texCoord;
uniform vec4 offset; uniform mat4 matrix; uniform int mode;
out vec4 varied; out vec2 coord; flat out int instance;
void main() {
    instance = gl_InstanceID + gl_VertexID % 3;
    varied = color * 0.5 + 0.5;
    coord = texCoord;
    vec4 p = vec4(position.xyz + offset.xyz * 0.3 + float(gl_InstanceID) * 0.1, 1.0);
    gl_Position = p + matrix * p * 0.1 * float(mode);
    gl_PointSize = 5.0;
})";
constexpr const char* kCoreFragment = R"(#version 150
uniform vec4 tint; uniform sampler2D image; uniform float scale[3];
in vec4 varied; in vec2 coord; flat in int instance;
out vec4 result;
void main() {
    if (instance == 2 && gl_FragCoord.x > 40.0) discard;
    result = varied + tint * 0.5 + texture(image, coord) * 0.25 + vec4(dFdx(varied.x), scale[0] * 0.01, float(instance) * 0.1, 0.0);
})";
constexpr const char* kTwoOutputs = R"(#version 150
uniform vec4 tint; in vec4 varied; out vec4 result; out vec4 second;
void main() { result = varied; second = tint + vec4(fract(gl_FragCoord.xy * 0.3), 0.0, 1.0); })";
constexpr const char* kGeometry = R"(#version 150
layout(triangles) in; layout(triangle_strip, max_vertices = 6) out;
in vec4 varied[]; in vec2 coord[]; flat in int instance[];
out vec4 gvaried; 
void main() {
    for (int copy = 0; copy < 2; ++copy) {
        for (int i = 0; i < 3; ++i) {
            gvaried = varied[i].zyxw;
            gl_Position = gl_in[i].gl_Position * (copy == 0 ? 1.0 : -0.5) + vec4(0.0, 0.0, 0.0, copy == 0 ? 0.0 : 1.5);
            gl_PrimitiveID = copy;
            EmitVertex();
        }
        EndPrimitive();
    }
})";
constexpr const char* kGeometryFragment = R"(#version 150
in vec4 gvaried; out vec4 result;
void main() { result = gvaried + vec4(float(gl_PrimitiveID) * 0.3, 0.0, 0.0, 0.0); })";
constexpr const char* kBlockVertex = R"(#version 330
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(std140) uniform Block { vec4 offset; vec4 more[4]; };
out vec4 varied; out vec4 captured;
void main() {
    captured = position.wzyx + color;
    varied = color + more[gl_VertexID & 3] * 0.1;
    gl_Position = vec4(position.xy + clamp(offset.xy, -0.3, 0.3), position.z, 1.0);
})";
constexpr const char* kBlockFragment = R"(#version 330
uniform vec4 tint; in vec4 varied; layout(location = 0) out vec4 result;
void main() { result = varied * 0.5 + tint; })";
constexpr const char* kStorageVertex = R"(#version 430
layout(location = 0) in vec4 position; layout(location = 1) in ivec4 color;
layout(location = 3) uniform vec4 offset;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; };
out vec4 varied;
void main() { varied = vec4(color & 7) * 0.14; gl_Position = vec4(position.xyz + offset.xyz * 0.2, 1.0); gl_PointSize = 2.0; })";
constexpr const char* kStorageFragment = R"(#version 430
layout(location = 4) uniform vec4 tint; in vec4 varied; out vec4 result;
layout(std430, binding = 0) readonly buffer Values { uint values[]; };
void main() {
    uint value = values.length() > 3 ? values[(uint(gl_FragCoord.x) >> 4) & 3u] : 0u;
    result = varied + tint * 0.5 + float(value & 7u) * 0.05;
})";
constexpr const char* kCountingFragment = R"(#version 430
layout(location = 4) uniform vec4 tint; in vec4 varied; out vec4 result;
layout(std430, binding = 0) buffer Values { uint values[]; };
void main() {
    if (values.length() > 3) atomicAdd(values[(uint(gl_FragCoord.x) >> 4) & 3u], 1u);
    result = varied + tint * 0.5;
})";
constexpr const char* kControl = R"(#version 400
layout(vertices = 3) out;
in vec4 varied[]; out vec4 tvaried[];
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    tvaried[gl_InvocationID] = varied[gl_InvocationID];
    gl_TessLevelInner[0] = 2.0;
    gl_TessLevelOuter[0] = 2.0; gl_TessLevelOuter[1] = 3.0; gl_TessLevelOuter[2] = 1.0;
})";
constexpr const char* kEvaluation = R"(#version 400
layout(triangles, equal_spacing, ccw) in;
in vec4 tvaried[]; out vec4 gvaried;
void main() {
    gvaried = tvaried[0] * gl_TessCoord.x + tvaried[1] * gl_TessCoord.y + vec4(gl_TessCoord, 1.0) * 0.4;
    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +
                  gl_TessCoord.z * gl_in[2].gl_Position;
})";
constexpr const char* kCompute = R"(#version 430
layout(local_size_x = 4) in;
layout(std430, binding = 0) buffer Values { uint values[]; };
uniform int mode;
void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * 4u;
    if (i < uint(values.length())) values[i] = values[i] * 3u + i + uint(mode);
})";
constexpr const char* kDoubles = R"(#version 410
in vec4 position; uniform dvec2 offset; uniform uvec3 mode; uniform mat2x3 matrix;
flat out uvec3 varied;
void main() {
    varied = mode;
    gl_Position = vec4(position.xy + vec2(offset) * 0.2 + (matrix * vec2(0.1)).xy * 0.1, position.z, 1.0);
})";
constexpr const char* kDoublesFragment = R"(#version 410
flat in uvec3 varied; uniform usampler2D image; uniform bool scale[3]; out vec4 result;
void main() {
    result = vec4(varied & 3u, 3u) / 3.0 + vec4(texelFetch(image, ivec2(1), 0) & 1u) * (scale[2] ? 0.5 : 0.1);
})";
constexpr const char* kCube = R"(#version 330
in vec4 varied; in vec2 coord; uniform samplerCube image; uniform sampler2DArray layers; out vec4 result;
void main() { result = texture(image, varied.xyz - 0.5) * 0.7 + texture(layers, vec3(coord, varied.x * 2.0)) * 0.5; })";
constexpr const char* kEs2Vertex = R"(attribute vec4 position; attribute vec4 color; attribute vec2 texCoord;
uniform vec4 offset; uniform mat4 matrix; varying vec4 varied; varying vec2 coord;
void main() {
    varied = color; coord = texCoord;
    vec4 p = vec4(position.xyz + offset.xyz * 0.3, 1.0);
    gl_Position = p + matrix * p * 0.1; gl_PointSize = 4.0;
})";
constexpr const char* kEs2Fragment = R"(precision mediump float;
uniform vec4 tint; uniform sampler2D image; varying vec4 varied; varying vec2 coord;
void main() { gl_FragColor = varied * 0.5 + tint * 0.3 + texture2D(image, coord) * 0.3 + vec4(fract(gl_FragCoord.xy * 0.07), gl_PointCoord) * 0.1; })";
constexpr const char* kEs3Vertex = R"(#version 300 es
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color; in vec2 texCoord;
layout(std140) uniform Block { vec4 offset; vec4 more[4]; };
uniform int mode; out vec4 varied; out vec4 captured; out vec2 coord;
void main() {
    varied = color * 0.5 + more[1] * 0.1; coord = texCoord;
    captured = position.yxwz * 2.0 + float(gl_VertexID);
    gl_Position = vec4(position.xyz + clamp(offset.xyz, -0.2, 0.2) + float(gl_InstanceID * mode) * 0.01, 1.0);
    gl_PointSize = 2.0;
})";
constexpr const char* kEs3Fragment = R"(#version 300 es
precision highp float; precision highp sampler3D;
uniform vec4 tint; uniform sampler2D image; uniform sampler3D deep; in vec4 varied; in vec2 coord; out vec4 result;
void main() { result = varied + tint * 0.3 + texture(image, coord) * 0.3 + texture(deep, varied.xyz) * 0.2; })";
constexpr const char* kEs31Compute = R"(#version 310 es
layout(local_size_x = 2) in;
layout(std430, binding = 0) buffer Values { uint values[]; };
uniform int mode;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(values.length())) values[i] = values[i] + i * 5u + uint(mode);
})";

} // namespace

const std::vector<PoolProgram>& programPool() {
    static const std::vector<PoolProgram> pool = {
        {"c", {{GL_VERTEX_SHADER, kOldVertex}, {GL_FRAGMENT_SHADER, kOldFragment}}},
        {"c", {{GL_FRAGMENT_SHADER, kFrontFragment}}},
        {"c", {{GL_VERTEX_SHADER, kOldVertex}}, "varied"},
        {"ck", {{GL_VERTEX_SHADER, kCoreVertex}, {GL_FRAGMENT_SHADER, kCoreFragment}}, "coord"},
        {"ck", {{GL_VERTEX_SHADER, kCoreVertex}, {GL_FRAGMENT_SHADER, kTwoOutputs}}},
        {"ck", {{GL_VERTEX_SHADER, kCoreVertex}, {GL_FRAGMENT_SHADER, kCube}}},
        {"ck",
         {{GL_VERTEX_SHADER, kCoreVertex}, {GL_GEOMETRY_SHADER, kGeometry}, {GL_FRAGMENT_SHADER, kGeometryFragment}},
         "gvaried"},
        {"ck", {{GL_VERTEX_SHADER, kBlockVertex}, {GL_FRAGMENT_SHADER, kBlockFragment}}, "captured"},
        {"ck", {{GL_VERTEX_SHADER, kStorageVertex}, {GL_FRAGMENT_SHADER, kStorageFragment}}},
        {"ck", {{GL_VERTEX_SHADER, kStorageVertex}, {GL_FRAGMENT_SHADER, kCountingFragment}}, nullptr, false, true},
        {"ck", {{GL_VERTEX_SHADER, kDoubles}, {GL_FRAGMENT_SHADER, kDoublesFragment}}},
        {"ck",
         {{GL_VERTEX_SHADER, kCoreVertex},
          {GL_TESS_CONTROL_SHADER, kControl},
          {GL_TESS_EVALUATION_SHADER, kEvaluation},
          {GL_FRAGMENT_SHADER, "#version 400\nin vec4 gvaried; out vec4 result;\nvoid main() { result = gvaried; }"}},
         nullptr,
         true},
        {"ck", {{GL_COMPUTE_SHADER, kCompute}}},
        {"3", {{GL_VERTEX_SHADER, kEs2Vertex}, {GL_FRAGMENT_SHADER, kEs2Fragment}}},
        {"3", {{GL_VERTEX_SHADER, kEs3Vertex}, {GL_FRAGMENT_SHADER, kEs3Fragment}}, "captured"},
        {"3", {{GL_COMPUTE_SHADER, kEs31Compute}}},
        // A program that neither compiles nor links.
        {"ck3", {{GL_VERTEX_SHADER, "void main() { gl_Position = nothing; }"}, {GL_FRAGMENT_SHADER, "void main() {"}}},
    };
    return pool;
}

const char* const* arbPrograms() {
    static const char* const programs[] = {
        "!!ARBvp1.0\nPARAM e = program.env[1];\nPARAM l = program.local[2];\nTEMP p;\nMUL p, vertex.position, {0.8, "
        "0.8, 1, 1};\n"
        "MAD result.position, e, {0.1, 0.1, 0, 0}, p;\nADD result.color, vertex.color, l;\nMOV result.texcoord[0], "
        "vertex.position;\nEND\n",
        "!!ARBvp1.0\nOPTION ARB_position_invariant;\nMOV result.color, vertex.normal;\nEND\n",
        "!!ARBfp1.0\nPARAM l = program.local[1];\nTEMP t;\nTEX t, fragment.texcoord[0], texture[0], 2D;\n"
        "MAD result.color, t, {0.5, 0.5, 0.5, 0.5}, l;\nEND\n",
        "!!ARBfp1.0\nPARAM e = program.env[0];\nMAD result.color, fragment.color, {0.7, 0.7, 0.7, 0.7}, e;\nEND\n",
        "!!ARBfp1.0\nMUL result.color, fragment.position, {0.015, 0.02, 0.5, 1};\nEND\n",
        nullptr};
    return programs;
}

} // namespace fuzz
