// The number of values that GL reads for each of the 65536 possible pnames, measured with a guard page. The array
// starts so close to the guard that only `count` values precede it.
#include "tests/streamcodec/sizes_gl_context.hpp"

#include <cstring>
#include <memory>

#include "streamcodec/sizes/gl_enums.hpp"
#include "streamcodec/sizes/parameter_counts.hpp"
#include "tests/streamcodec/sizes_guarded_memory.hpp"

namespace mural::sizes {
namespace {

constexpr size_t kMaxValues = 16;

class ParameterCountsGl : public testing::TestWithParam<TestApi> {
protected:
    void SetUp() override {
        context_ = std::make_unique<TestContext>(GetParam());
        if (!context_->valid()) GTEST_SKIP() << "no such context over EGL surfaceless here";
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
    }

    // The bytes that a call reads at its pointer.
    template <class Call> size_t bytesRead(size_t valueBytes, const Call& call) {
        for (size_t count = 0; count < kMaxValues; ++count) {
            memory_.close();
            call(memory_.end() - count * valueBytes);
            takeErrors();
            if (!memory_.touched()) return count * valueBytes;
        }
        return kMaxValues * valueBytes;
    }

    // call(pname, pointer). GL must never read more than `countOf` returns, and exactly that many if it accepts the
    // pname (with zeros as values).
    template <class Call>
    void check(const char* name, size_t valueBytes, uint32_t (*countOf)(GLenum), const Call& call) {
        int taken = 0;
        for (GLenum pname = 0; pname <= 0xffff; ++pname) {
            const size_t expected = countOf(pname) * valueBytes;
            memory_.close();
            call(pname, memory_.end() - expected);
            const bool refused = takeErrors();
            if (refused && valueBytes == sizeof(GLdouble))
                continue; // Mesa converts four doubles before it checks the pname
            EXPECT_FALSE(memory_.touched()) << name << " reads more, pname " << std::hex << pname;
            if (refused) continue;
            ++taken;
            EXPECT_EQ(bytesRead(valueBytes, [&](void* values) { call(pname, values); }), expected)
                << name << " pname " << std::hex << pname;
        }
        std::printf("%s: %d pnames\n", name, taken);
        EXPECT_GT(taken, 0) << name;
    }

    GuardedMemory memory_{4096};
    std::unique_ptr<TestContext> context_;
};

// For commands of one API only.
class DesktopParameterCountsGl : public ParameterCountsGl {};
class Es1ParameterCountsGl : public ParameterCountsGl {};

const GLfloat* floats(void* values) { return static_cast<const GLfloat*>(values); }
const GLint* ints(void* values) { return static_cast<const GLint*>(values); }
const GLfixed* fixeds(void* values) { return static_cast<const GLfixed*>(values); }

TEST_P(ParameterCountsGl, matchTextureParameters) {
    check("glTexParameterfv", 4, texParameterCount,
          [](GLenum p, void* v) { glTexParameterfv(GL_TEXTURE_2D, p, floats(v)); });
    check("glTexParameteriv", 4, texParameterCount,
          [](GLenum p, void* v) { glTexParameteriv(GL_TEXTURE_2D, p, ints(v)); });
    if (GetParam() != TestApi::Compatibility) return;
    check("glTexParameterIiv", 4, texParameterCount,
          [](GLenum p, void* v) { glTexParameterIiv(GL_TEXTURE_2D, p, ints(v)); });
    GLuint sampler = 0;
    glGenSamplers(1, &sampler);
    check("glSamplerParameterfv", 4, samplerParameterCount,
          [=](GLenum p, void* v) { glSamplerParameterfv(sampler, p, floats(v)); });
    check("glSamplerParameterIiv", 4, samplerParameterCount,
          [=](GLenum p, void* v) { glSamplerParameterIiv(sampler, p, ints(v)); });
}

TEST_P(ParameterCountsGl, matchFixedFunctionParameters) {
    for (GLenum target : {GL_TEXTURE_ENV, GL_TEXTURE_FILTER_CONTROL, GL_POINT_SPRITE}) {
        if (target == GL_TEXTURE_FILTER_CONTROL && GetParam() == TestApi::Es1) continue;
        check("glTexEnvfv", 4, texEnvCount, [=](GLenum p, void* v) { glTexEnvfv(target, p, floats(v)); });
        check("glTexEnviv", 4, texEnvCount, [=](GLenum p, void* v) { glTexEnviv(target, p, ints(v)); });
    }
    check("glLightfv", 4, lightCount, [](GLenum p, void* v) { glLightfv(GL_LIGHT0, p, floats(v)); });
    check("glLightModelfv", 4, lightModelCount, [](GLenum p, void* v) { glLightModelfv(p, floats(v)); });
    check("glMaterialfv", 4, materialCount, [](GLenum p, void* v) { glMaterialfv(GL_FRONT_AND_BACK, p, floats(v)); });
    check("glFogfv", 4, fogCount, [](GLenum p, void* v) { glFogfv(p, floats(v)); });
    check("glPointParameterfv", 4, pointParameterCount, [](GLenum p, void* v) { glPointParameterfv(p, floats(v)); });
}

TEST_P(DesktopParameterCountsGl, matchDesktopParameters) {
    check("glTexGenfv", 4, texGenCount, [](GLenum p, void* v) { glTexGenfv(GL_S, p, floats(v)); });
    check("glTexGendv", 8, texGenCount, [](GLenum p, void* v) { glTexGendv(GL_S, p, static_cast<GLdouble*>(v)); });
    check("glLightiv", 4, lightCount, [](GLenum p, void* v) { glLightiv(GL_LIGHT0, p, ints(v)); });
    check("glLightModeliv", 4, lightModelCount, [](GLenum p, void* v) { glLightModeliv(p, ints(v)); });
    check("glMaterialiv", 4, materialCount, [](GLenum p, void* v) { glMaterialiv(GL_FRONT_AND_BACK, p, ints(v)); });
    check("glFogiv", 4, fogCount, [](GLenum p, void* v) { glFogiv(p, ints(v)); });
    check("glPointParameteriv", 4, pointParameterCount, [](GLenum p, void* v) { glPointParameteriv(p, ints(v)); });
    check("glPatchParameterfv", 4, patchParameterCount, [](GLenum p, void* v) { glPatchParameterfv(p, floats(v)); });
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    check("glTextureParameterfv", 4, texParameterCount,
          [=](GLenum p, void* v) { glTextureParameterfv(texture, p, floats(v)); });
    check("glMultiTexEnvfvEXT", 4, texEnvCount,
          [](GLenum p, void* v) { glMultiTexEnvfvEXT(GL_TEXTURE1, GL_TEXTURE_ENV, p, floats(v)); });
}

TEST_P(Es1ParameterCountsGl, matchFixedPointParameters) {
    const auto lightx = reinterpret_cast<void (*)(GLenum, GLenum, const GLfixed*)>(procAddress("glLightxv"));
    const auto fogx = reinterpret_cast<void (*)(GLenum, const GLfixed*)>(procAddress("glFogxv"));
    const auto texx = reinterpret_cast<void (*)(GLenum, GLenum, const GLfixed*)>(procAddress("glTexParameterxv"));
    check("glLightxv", 4, lightCount, [=](GLenum p, void* v) { lightx(GL_LIGHT0, p, fixeds(v)); });
    check("glFogxv", 4, fogCount, [=](GLenum p, void* v) { fogx(p, fixeds(v)); });
    check("glTexParameterxv", 4, texParameterCount, [=](GLenum p, void* v) { texx(GL_TEXTURE_2D, p, fixeds(v)); });
}

TEST_P(DesktopParameterCountsGl, matchClearBuffers) {
    TestFramebuffer framebuffer(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    ASSERT_TRUE(framebuffer.complete());
    GLuint depth = 0; // GL reads the value only if such a buffer exists
    glGenRenderbuffers(1, &depth);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, 32, 32);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    check("glClearBufferfv", 4, clearBufferCount, [](GLenum b, void* v) { glClearBufferfv(b, 0, floats(v)); });
}

// Evaluator maps and display list names have no pname: the exact span is sufficient, one value less is not.
template <class Call> void expectExact(GuardedMemory& memory, size_t bytes, const Call& call, const char* what) {
    memory.close();
    call(memory.end() - bytes);
    EXPECT_FALSE(memory.touched()) << what << ": GL reads more than " << bytes;
    if (bytes == 0) return;
    memory.close();
    call(memory.end() - bytes + 1);
    EXPECT_TRUE(memory.touched()) << what << ": GL reads less than " << bytes;
    takeErrors();
}

TEST_P(DesktopParameterCountsGl, matchEvaluatorMaps) {
    const auto isVertexAttribute = [](GLenum target) { return target >= 0x8000 && mapComponents(target) != 0; };
    for (GLenum target = 0; target <= 0xffff; ++target)
        for (GLint stride : {1, 3, 4, 6}) {
            if (isVertexAttribute(target)) continue; // NV_vertex_program: removed from Mesa
            expectExact(
                memory_, map1Values(target, stride, 4) * 4,
                [&](void* p) { glMap1f(target, 0, 1, stride, 4, floats(p)); }, "glMap1f");
            expectExact(
                memory_, map2Values(target, 5 * stride, 3, stride, 5) * 8,
                [&](void* p) { glMap2d(target, 0, 1, 5 * stride, 3, 0, 1, stride, 5, static_cast<GLdouble*>(p)); },
                "glMap2d");
            expectExact(
                memory_, map2Values(target, stride, 3, 4 * stride, 5) * 4,
                [&](void* p) { glMap2f(target, 0, 1, stride, 3, 0, 1, 4 * stride, 5, floats(p)); }, "glMap2f");
            if (HasFailure()) FAIL() << "target " << std::hex << target << " stride " << stride;
        }
}

TEST_P(DesktopParameterCountsGl, matchDisplayListNames) {
    glNewList(1, GL_COMPILE);
    glEndList();
    for (GLenum type = 0; type <= 0xffff; ++type) {
        expectExact(
            memory_, callListsBytes(5, type), [&](void* p) { glCallLists(5, type, p); }, "glCallLists");
        if (HasFailure()) FAIL() << "type " << std::hex << type;
    }
}

constexpr auto nameOfApi = [](const testing::TestParamInfo<TestApi>& api) {
    return std::string(api.param == TestApi::Es1 ? "Es1" : "Compatibility");
};
INSTANTIATE_TEST_SUITE_P(Apis, ParameterCountsGl, testing::Values(TestApi::Compatibility, TestApi::Es1), nameOfApi);
INSTANTIATE_TEST_SUITE_P(Apis, DesktopParameterCountsGl, testing::Values(TestApi::Compatibility), nameOfApi);
INSTANTIATE_TEST_SUITE_P(Apis, Es1ParameterCountsGl, testing::Values(TestApi::Es1), nameOfApi);

} // namespace
} // namespace mural::sizes
