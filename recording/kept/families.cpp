#include "recording/kept/families.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <string_view>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/command_parameters.hpp"
#include "streamcodec/opcode_names.hpp"

namespace mural::recording {
namespace {

struct NamedRule {
    std::string_view pattern; // `*`: anything
    Family family;
    uint32_t attribBits = 0;
    ObjectType type = ObjectType::None;
};

using enum Family;

// The first that fits. A command that is in none of them costs bytes, one that is in a wrong one costs pictures: so patterns name
// what was looked at.
constexpr NamedRule kRules[] = {
    // ---- what only changes pictures
    {"glDrawArrays*", Draw}, {"glDrawElements*", Draw}, {"glDrawRangeElements", Draw}, {"glDrawRangeElementsBaseVertex", Draw},
    {"glMultiDrawArrays*", Draw}, {"glMultiDrawElements", Draw}, {"glMultiDrawElementsBaseVertex", Draw}, {"glMultiDrawElementsIndirect*", Draw},
    {"glDrawTransformFeedback*", Draw}, {"glRectd", Draw}, {"glRectdv", Draw}, {"glRectf", Draw}, {"glRectfv", Draw}, {"glRecti", Draw}, {"glRectiv", Draw},
    {"glRects", Draw}, {"glRectsv", Draw}, {"glDrawPixels", Draw}, {"glBitmap", Draw}, {"glCopyPixels", Draw}, {"glDrawTex[fisx]*OES", Draw},
    {"glEvalMesh?", Draw}, {"glAccum", Draw}, {"glDispatchCompute", Compute}, {"glDispatchComputeIndirect", Compute},
    {"glMemoryBarrier*", Barrier}, {"glTextureBarrier*", Barrier}, {"glBlendBarrier", Barrier},
    {"glClear", Clear}, {"glClearBufferfv", ClearBuffer}, {"glClearBufferiv", ClearBuffer}, {"glClearBufferuiv", ClearBuffer}, {"glClearBufferfi", ClearBuffer},
    {"glBlitFramebuffer", Blit}, {"glBegin", Begin}, {"glEnd", End}, {"glVertexP[234]*", Vertex}, {"glVertex[234]*", Vertex}, {"glEvalCoord*", Vertex}, {"glEvalPoint?", Vertex},
    {"glArrayElement", Vertex}, {"glPrimitiveRestartNV", Vertex}, {"glNewList", NewList}, {"glEndList", EndList}, {"glCallList", CallList}, {"glCallLists", CallLists},
    {"glGenLists", GenLists}, {"glDeleteLists", DeleteList}, {"glListBase", ListBase, GL_LIST_BIT},
    // ---- nothing that stays
    {"glFlush", Nothing}, {"glFinish", Nothing}, {"glWaitSync", Nothing}, {"glHint", Cell, GL_HINT_BIT}, {"glValidateProgram*", Nothing},
    {"glObjectLabel", Nothing}, {"glObjectPtrLabel", Nothing}, {"glPushDebugGroup", Nothing}, {"glPopDebugGroup", Nothing},
    {"glInvalidateFramebuffer", Nothing}, {"glInvalidateSubFramebuffer", Nothing}, {"glDiscardFramebufferEXT", Nothing},
    {"glInitNames", Nothing}, {"glLoadName", Nothing}, {"glPushName", Nothing}, {"glPopName", Nothing}, {"glDebugMessageControl", Cell, kNoAttribBit}, {"glReleaseShaderCompiler", Nothing}, {"glPrioritizeTextures*", Nothing},
    // ---- current values
    {"glColorMask", Limit, GL_COLOR_BUFFER_BIT}, {"glColorMaterial", Cell, GL_LIGHTING_BIT}, {"glColorMaski", Limit, GL_COLOR_BUFFER_BIT},
    {"glColor3*", Color, GL_CURRENT_BIT}, {"glColor4*", Color, GL_CURRENT_BIT}, {"glColorP*ui*", Color, GL_CURRENT_BIT},
    {"glColorPointer", ArrayPointer}, {"glSecondaryColorPointer", ArrayPointer}, {"glSecondaryColor*", Attribute, GL_CURRENT_BIT},
    {"glNormalPointer", ArrayPointer}, {"glNormalFormatNV", Unknown}, {"glNormal3*", Attribute, GL_CURRENT_BIT}, {"glNormalP3*", Attribute, GL_CURRENT_BIT},
    {"glTexCoordPointer", ArrayPointer}, {"glTexCoordFormatNV", Unknown}, {"glTexCoord[1234]*", Attribute, GL_CURRENT_BIT}, {"glTexCoordP*", Attribute, GL_CURRENT_BIT},
    {"glMultiTexCoord[1234P]*", Attribute, GL_CURRENT_BIT}, {"glFogCoordPointer", ArrayPointer}, {"glFogCoord[df]*", Attribute, GL_CURRENT_BIT},
    {"glEdgeFlagPointer", ArrayPointer}, {"glEdgeFlag", Attribute, GL_CURRENT_BIT}, {"glEdgeFlagv", Attribute, GL_CURRENT_BIT},
    {"glIndexPointer", ArrayPointer}, {"glIndexMask", Cell, GL_COLOR_BUFFER_BIT}, {"glIndex[dfis]*", Attribute, GL_CURRENT_BIT}, {"glIndexub*", Attribute, GL_CURRENT_BIT},
    {"glMaterial*", Attribute, GL_LIGHTING_BIT}, {"glVertexPointer", ArrayPointer}, {"glPointSizePointerOES", ArrayPointer},
    {"glVertexAttribPointer", ArrayPointer}, {"glVertexAttribIPointer", ArrayPointer}, {"glVertexAttribLPointer", ArrayPointer},
    {"glVertexAttrib*FormatNV", Unknown}, {"glVertexAttribFormat", ArraySet}, {"glVertexAttribIFormat", ArraySet}, {"glVertexAttribLFormat", ArraySet},
    {"glVertexAttribBinding", ArraySet}, {"glVertexAttribDivisor", ArraySet}, {"glVertexBindingDivisor", ArraySet},
    {"glVertexAttribs*NV", Unknown}, {"glVertexAttribArrayObjectATI", Unknown}, {"glVertexAttribParameteriAMD", Unknown},
    {"glVertexAttrib[1234]*", Attribute, GL_CURRENT_BIT}, {"glVertexAttrib[ILP][1234]*", Attribute, GL_CURRENT_BIT},
    {"glRasterPos*", CellOfAll, GL_CURRENT_BIT}, {"glWindowPos*", CellOfAll, GL_CURRENT_BIT},
    // ---- state
    {"glEnable", Cap, GL_ENABLE_BIT}, {"glDisable", Cap, GL_ENABLE_BIT}, {"glEnablei", Cap}, {"glDisablei", Cap},
    {"glAlphaFunc", Cell, GL_COLOR_BUFFER_BIT}, {"glAlphaFuncx*", Cell, GL_COLOR_BUFFER_BIT}, {"glBlendColor*", Cell, GL_COLOR_BUFFER_BIT},
    {"glBlendEquation*", Cell, GL_COLOR_BUFFER_BIT}, {"glBlendFunc*", Cell, GL_COLOR_BUFFER_BIT}, {"glLogicOp", Cell, GL_COLOR_BUFFER_BIT},
    {"glClearColor*", Cell, GL_COLOR_BUFFER_BIT}, {"glClearIndex", Cell, GL_COLOR_BUFFER_BIT}, {"glClearAccum*", Cell, GL_ACCUM_BUFFER_BIT},
    {"glClearDepth", Cell, GL_DEPTH_BUFFER_BIT}, {"glClearDepthf", Cell, GL_DEPTH_BUFFER_BIT}, {"glClearDepthx*", Cell, GL_DEPTH_BUFFER_BIT},
    {"glClearStencil", Cell, GL_STENCIL_BUFFER_BIT}, {"glClampColor", Cell}, {"glClipControl", Cell}, {"glClipPlane*", CellOfMatrix, GL_TRANSFORM_BIT},
    {"glCullFace", Cell, GL_POLYGON_BIT}, {"glFrontFace", Cell, GL_POLYGON_BIT}, {"glPolygonMode", Cell, GL_POLYGON_BIT}, {"glPolygonOffset*", Cell, GL_POLYGON_BIT},
    {"glPolygonStipple", PatternedCell, GL_POLYGON_STIPPLE_BIT}, {"glDepthFunc", Cell, GL_DEPTH_BUFFER_BIT}, {"glDepthMask", Limit, GL_DEPTH_BUFFER_BIT},
    {"glDepthRange", Cell, GL_VIEWPORT_BIT}, {"glDepthRangef", Cell, GL_VIEWPORT_BIT}, {"glDepthRangex*", Cell, GL_VIEWPORT_BIT},
    {"glDepthRangeArrayv", Cell, GL_VIEWPORT_BIT}, {"glDepthRangeIndexed", Cell, GL_VIEWPORT_BIT}, {"glDepthBoundsEXT", Cell},
    {"glFogf", Cell, GL_FOG_BIT}, {"glFogfv", Cell, GL_FOG_BIT}, {"glFogi", Cell, GL_FOG_BIT}, {"glFogiv", Cell, GL_FOG_BIT}, {"glFogx*", Cell, GL_FOG_BIT},
    {"glLightModel*", Cell, GL_LIGHTING_BIT}, {"glLight[fix]*", CellOfMatrix, GL_LIGHTING_BIT}, {"glShadeModel", Cell, GL_LIGHTING_BIT},
    {"glLineStipple", Cell, GL_LINE_BIT}, {"glLineWidth", Cell, GL_LINE_BIT}, {"glLineWidthx*", Cell, GL_LINE_BIT},
    {"glPointSize", Cell, GL_POINT_BIT}, {"glPointSizex*", Cell, GL_POINT_BIT}, {"glPointParameter*", Cell, GL_POINT_BIT},
    {"glMap1[df]", PatternedCell, GL_EVAL_BIT}, {"glMap2[df]", PatternedCell, GL_EVAL_BIT}, {"glMapGrid*", Cell, GL_EVAL_BIT},
    {"glMinSampleShading", Cell}, {"glSampleCoverage*", Cell, GL_MULTISAMPLE_BIT}, {"glSampleMaski", Cell}, {"glPatchParameter*", Cell},
    {"glPrimitiveRestartIndex", Cell, kNoAttribBit}, {"glProvokingVertex", Cell}, {"glPrimitiveBoundingBox", Cell, kNoAttribBit},
    {"glPixelZoom*", Cell, GL_PIXEL_MODE_BIT}, {"glPixelTransfer*", Cell, GL_PIXEL_MODE_BIT}, {"glPixelMap*v", PatternedCell, kNoAttribBit},
    {"glPixelStore*", ClientCell}, {"glScissor", Cell, GL_SCISSOR_BIT}, {"glScissorIndexed*", Limit, GL_SCISSOR_BIT}, {"glScissorArrayv", Limit, GL_SCISSOR_BIT},
    {"glStencilFunc", Cell, GL_STENCIL_BUFFER_BIT}, {"glStencilFuncSeparate", Cell, GL_STENCIL_BUFFER_BIT}, {"glStencilOp", Cell, GL_STENCIL_BUFFER_BIT},
    {"glStencilOpSeparate", Cell, GL_STENCIL_BUFFER_BIT}, {"glStencilMask", Limit, GL_STENCIL_BUFFER_BIT}, {"glStencilMaskSeparate", Limit, GL_STENCIL_BUFFER_BIT},
    {"glActiveStencilFaceEXT", UnknownNames},
    {"glViewport", Cell, GL_VIEWPORT_BIT}, {"glViewportArrayv", Cell, GL_VIEWPORT_BIT}, {"glViewportIndexedf", Cell, GL_VIEWPORT_BIT}, {"glViewportIndexedfv", Cell, GL_VIEWPORT_BIT},
    {"glTexEnv*", UnitCell, GL_TEXTURE_BIT}, {"glTexGen*", UnitCellOfMatrix, GL_TEXTURE_BIT},
    {"glActiveTexture", ActiveTexture, GL_TEXTURE_BIT}, {"glClientActiveTexture", ClientActiveTexture}, {"glMatrixMode", MatrixMode, GL_TRANSFORM_BIT},
    {"glEnableClientState", ClientCap}, {"glDisableClientState", ClientCap}, {"glEnableVertexAttribArray", ArraySet}, {"glDisableVertexAttribArray", ArraySet},
    {"glLockArraysEXT", Nothing}, {"glUnlockArraysEXT", Nothing}, // promises that no draw depends on
    // ---- matrices
    {"glLoadIdentity", MatrixLoad}, {"glLoadMatrix*", MatrixLoad}, {"glLoadTransposeMatrix[df]", MatrixLoad},
    {"glMultMatrix*", MatrixChange}, {"glMultTransposeMatrix[df]", MatrixChange}, {"glRotate*", MatrixChange}, {"glScale[dfx]*", MatrixChange},
    {"glTranslate*", MatrixChange}, {"glFrustum*", MatrixChange}, {"glOrtho*", MatrixChange}, {"glPushMatrix", MatrixPush}, {"glPopMatrix", MatrixPop},
    {"glPushAttrib", AttribPush}, {"glPopAttrib", AttribPop}, {"glPushClientAttrib", ClientPush}, {"glPopClientAttrib", ClientPop},
    // ---- names
    {"glGenTextures", Gen, 0, ObjectType::Texture}, {"glGenBuffers", Gen, 0, ObjectType::Buffer}, {"glGenFramebuffers", Gen, 0, ObjectType::Framebuffer},
    {"glGenRenderbuffers", Gen, 0, ObjectType::Renderbuffer}, {"glGenVertexArrays", Gen, 0, ObjectType::VertexArray}, {"glGenQueries", Gen, 0, ObjectType::Query},
    {"glGenSamplers", Gen, 0, ObjectType::Sampler}, {"glGenProgramPipelines", Gen, 0, ObjectType::Pipeline}, {"glGenTransformFeedbacks", Gen, 0, ObjectType::Feedback},
    {"glGenProgramsARB", Gen, 0, ObjectType::ArbProgram},
    {"glCreateTextures", Gen, 0, ObjectType::Texture}, {"glCreateBuffers", Gen, 0, ObjectType::Buffer}, {"glCreateFramebuffers", Gen, 0, ObjectType::Framebuffer},
    {"glCreateRenderbuffers", Gen, 0, ObjectType::Renderbuffer}, {"glCreateVertexArrays", Gen, 0, ObjectType::VertexArray}, {"glCreateQueries", Gen, 0, ObjectType::Query},
    {"glCreateSamplers", Gen, 0, ObjectType::Sampler}, {"glCreateProgramPipelines", Gen, 0, ObjectType::Pipeline}, {"glCreateTransformFeedbacks", Gen, 0, ObjectType::Feedback},
    {"glCreateShader", Create, 0, ObjectType::Program}, {"glCreateProgram", Create, 0, ObjectType::Program},
    {"glDeleteTextures", Delete, 0, ObjectType::Texture}, {"glDeleteBuffers", Delete, 0, ObjectType::Buffer}, {"glDeleteFramebuffers", Delete, 0, ObjectType::Framebuffer},
    {"glDeleteRenderbuffers", Delete, 0, ObjectType::Renderbuffer}, {"glDeleteVertexArrays", Delete, 0, ObjectType::VertexArray}, {"glDeleteQueries", Delete, 0, ObjectType::Query},
    {"glDeleteSamplers", Delete, 0, ObjectType::Sampler}, {"glDeleteProgramPipelines", Delete, 0, ObjectType::Pipeline},
    {"glDeleteTransformFeedbacks", Delete, 0, ObjectType::Feedback}, {"glDeleteProgramsARB", Delete, 0, ObjectType::ArbProgram},
    {"glDeleteProgram", ProgramDelete}, {"glDeleteShader", ShaderDelete}, {"glDeleteObjectARB", ProgramDelete},
    {"glFenceSync", SyncMake}, {"glDeleteSync", SyncDelete},
    {"glBindTexture", Bind, GL_TEXTURE_BIT, ObjectType::Texture}, {"glBindTextureUnit", BindIndexed, GL_TEXTURE_BIT, ObjectType::Texture},
    {"glBindBuffer", Bind, kNoAttribBit, ObjectType::Buffer}, {"glBindBufferBase", BindIndexed, kNoAttribBit, ObjectType::Buffer}, {"glBindBufferRange", BindIndexed, kNoAttribBit, ObjectType::Buffer},
    {"glBindFramebuffer*", Bind, kNoAttribBit, ObjectType::Framebuffer}, {"glBindRenderbuffer*", Bind, kNoAttribBit, ObjectType::Renderbuffer},
    {"glBindVertexArray", Bind, kNoAttribBit, ObjectType::VertexArray}, {"glBindSampler", BindIndexed, 0, ObjectType::Sampler}, {"glBindImageTexture", BindIndexed, kNoAttribBit, ObjectType::Texture},
    {"glBindProgramPipeline", Bind, kNoAttribBit, ObjectType::Pipeline}, {"glBindTransformFeedback", Bind, kNoAttribBit, ObjectType::Feedback},
    {"glBindProgramARB", Bind, 0, ObjectType::ArbProgram}, {"glUseProgram", UseProgram, kNoAttribBit, ObjectType::Program},
    {"glBindVertexBuffer", ArrayPointer}, {"glBindVertexBuffers", ArraySet}, {"glVertexArrayVertexBuffer", ArrayNamedSet}, {"glVertexArrayVertexBuffers", ArrayNamedSet}, {"glVertexArrayElementBuffer", ArrayNamedSet},
    {"glVertexArrayAttrib*", ArrayNamedSet}, {"glVertexArrayBindingDivisor", ArrayNamedSet}, {"glEnableVertexArrayAttrib", ArrayNamedSet}, {"glDisableVertexArrayAttrib", ArrayNamedSet},
    // ---- buffers
    {"glBufferData", BufferData}, {"glBufferStorage", BufferData}, {"glNamedBufferData", BufferData, 0, ObjectType::Buffer}, {"glNamedBufferStorage", BufferData, 0, ObjectType::Buffer},
    {"glBufferSubData", BufferSubData}, {"glNamedBufferSubData", BufferSubData, 0, ObjectType::Buffer},
    {"glInvalidateBuffer*Data", Nothing},
    // ---- textures
    {"glTextureStorage[123]D", TexStorage, 0, ObjectType::Texture}, {"glTextureSubImage[123]D", TexSubImage, 0, ObjectType::Texture},
    {"glTexParameter*", TexParameter}, {"glTexImage[123]D", TexImage}, {"glTexImage3DOES", TexImage}, {"glTexImage[23]DMultisample", TexImage}, {"glCompressedTexImage*", TexImage},
    {"glTexSubImage*", TexSubImage}, {"glCompressedTexSubImage*", TexSubImage}, {"glTexStorage[123]D", TexStorage}, {"glTexStorage[23]DMultisample", TexStorage},
    {"glCopyTexImage[12]D", TexCopyImage}, {"glCopyTexSubImage[123]D", TexCopySubImage}, {"glGenerateMipmap", TexMipmaps}, {"glGenerateMipmapOES", TexMipmaps}, {"glTexBuffer*", TexBuffer},
    {"glEGLImageTargetTexture2DOES", TexView}, {"glSamplerParameter*", NamedSet, 0, ObjectType::Sampler},
    {"glTextureParameteri", NamedSet, 0, ObjectType::Texture}, {"glTextureParameterf", NamedSet, 0, ObjectType::Texture},
    {"glTextureParameter[fi]v", NamedSet, 0, ObjectType::Texture}, {"glTextureParameterI*v", NamedSet, 0, ObjectType::Texture},
    // ---- handles of textures, pages of what is sparse
    {"glGetTextureHandleARB", Handle}, {"glGetTextureSamplerHandleARB", Handle}, {"glGetImageHandleARB", Handle}, {"glMake*Handle*ResidentARB", HandleResident},
    {"glTexPageCommitmentARB", TexPages}, {"glTexturePageCommitmentEXT", TexPages, 0, ObjectType::Texture},
    {"glBufferPageCommitmentARB", BufferPages}, {"glNamedBufferPageCommitment*", BufferPages, 0, ObjectType::Buffer},
    // ---- framebuffers
    {"glRenderbufferStorage", RenderbufferStorage}, {"glRenderbufferStorageMultisample", RenderbufferStorage},
    {"glFramebufferTexture", FramebufferAttach}, {"glFramebufferTexture[123]D", FramebufferAttach}, {"glFramebufferTextureLayer", FramebufferAttach},
    {"glFramebufferRenderbuffer", FramebufferAttach}, {"glFramebufferParameteri", FramebufferSet}, {"glReadBuffer", FramebufferSet}, {"glDrawBuffer", DrawBuffers}, {"glDrawBuffers", DrawBuffers},
    {"glNamedFramebuffer*", FramebufferNamed}, {"glFramebufferDrawBuffer*EXT", FramebufferNamed}, {"glFramebufferReadBufferEXT", FramebufferNamed},
    // ---- shaders and programs
    {"glUseProgramStages", PipelineSet}, {"glActiveShaderProgram", PipelineSet},
    {"glShaderSource", ShaderSet}, {"glCompileShader", ShaderCompile}, {"glAttachShader", ProgramAttach}, {"glDetachShader", ProgramDetach},
    {"glBindAttribLocation", ProgramSet}, {"glBindFragDataLocation*", ProgramSet}, {"glProgramParameteri", ProgramSet}, {"glTransformFeedbackVaryings", ProgramSet},
    {"glUniformBlockBinding", ProgramSet}, {"glShaderStorageBlockBinding", ProgramSet}, {"glLinkProgram", ProgramLink},
    {"glUniformSubroutinesuiv", Unknown}, {"glUniformBufferEXT", Unknown}, {"glUniform*NV", Unknown}, {"glUniform*", Uniform}, {"glProgramUniform*EXT", Unknown}, {"glProgramUniform*NV", Unknown},
    {"glProgramUniform*", ProgramUniform}, {"glProgramStringARB", ArbProgram}, {"glProgramLocalParameter*ARB", ArbProgram}, {"glProgramEnvParameter*ARB", Cell, kNoAttribBit},
    // ---- what has an end
    {"glBeginQuery", QueryBegin}, {"glEndQuery", QueryEnd}, {"glBeginQueryIndexed", QueryBegin}, {"glEndQueryIndexed", QueryEnd}, {"glQueryCounter", QueryCounter},
    {"glBeginTransformFeedback", FeedbackBegin}, {"glEndTransformFeedback", FeedbackEnd}, {"glEndConditionalRender", ConditionalEnd},
};

// Shell patterns of `*`, `?` and [abc]: fnmatch(3) would do, but takes its time for so many.
bool fits(std::string_view pattern, std::string_view name) {
    while (!pattern.empty()) {
        if (pattern[0] == '*') {
            for (size_t skip = 0; skip <= name.size(); ++skip)
                if (fits(pattern.substr(1), name.substr(skip))) return true;
            return false;
        }
        if (name.empty()) return false;
        if (pattern[0] == '[') {
            const size_t end = pattern.find(']');
            if (pattern.substr(1, end - 1).find(name[0]) == std::string_view::npos) return false;
            pattern.remove_prefix(end);
        } else if (pattern[0] != '?' && pattern[0] != name[0]) {
            return false;
        }
        pattern.remove_prefix(1);
        name.remove_prefix(1);
    }
    return name.empty();
}

bool changesNames(std::string_view name) {
    for (const std::string_view word : {"Bind", "Use", "Active", "Push", "Pop", "Begin", "End", "Delete", "Matrix", "List", "ClientAttrib"})
        if (name.find(word) != std::string_view::npos) return true;
    return false;
}

bool selects(const ParameterInfo& p, Family family) {
    const std::string_view name = p.name;
    if (family == Uniform || family == ProgramUniform) return name == "program" || name == "location" || name == "count";
    if (family == Attribute || family == Color) return p.element == Element::Enum || name == "index"; // other numbers are the value
    return p.element == Element::Enum || p.element == Element::U32 || p.element == Element::Bits || name == "level" || name == "count" || name == "first" || name == "n";
}

void findSelectors(Rule& rule, uint16_t opcode, std::string_view name) {
    // TexParameteri takes enums, as numbers: one that is an error must not stand for the one before it.
    const bool valueToo = name == "glTexParameteri" || name == "glTextureParameteri" || name == "glSamplerParameteri" || name == "glTexEnvi" || name == "glTexEnvf";
    size_t word = 0;
    for (const ParameterInfo& p : parametersOf(opcode).parameters) {
        if (p.travel != Travel::Scalar || word > 200) break;
        if ((valueToo || selects(p, rule.family)) && rule.selectors < rule.selectorWords.size()) rule.selectorWords[rule.selectors++] = static_cast<uint8_t>(word);
        word += bytesOf(p.element) == 8 ? 2 : 1;
    }
}

std::vector<Rule> allRules() {
    std::vector<Rule> rules(op::kLimit);
    for (uint16_t opcode = 0; opcode < rules.size(); ++opcode) {
        const char* const text = glOpcodeName(opcode);
        if (text == nullptr) continue;
        const std::string_view name = text;
        Rule& rule = rules[opcode];
        rule.family = changesNames(name) ? UnknownNames : Unknown;
        for (const NamedRule& r : kRules) {
            if (!fits(r.pattern, name)) continue;
            rule.family = r.family;
            rule.type = r.type;
            rule.attribBits = r.attribBits;
            break;
        }
        findSelectors(rule, opcode, name);
    }
    return rules;
}

} // namespace

const Rule& ruleOf(uint16_t opcode) {
    static const std::vector<Rule> kAll = allRules();
    static const Rule kNone;
    return opcode < kAll.size() ? kAll[opcode] : kNone;
}

} // namespace mural::recording
