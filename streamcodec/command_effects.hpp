// Effects of the GL commands: the state that each command reads and writes, for code that tracks a stream.
// Generated from the options `effect`, `object`, `deferral` and `attrib` of registry/semantics.txt. Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "gl_opcodes.hpp"

namespace mural {

enum class EffectKind : uint8_t {
    Unknown,      // may read and write anything
    UnknownNames, // may also change the meaning of later commands
    Nothing,      // has no lasting effect: queries, flushes
    // State of the context, replaced as a whole
    Cell,
    CellOfMatrix,
    CellOfAll,
    UnitCell,
    UnitCellOfMatrix,
    Cap,
    ClientCap,
    ClientCell,
    Attribute,
    Color,
    Limit,
    PatternedCell,
    ActiveTexture,
    ClientActiveTexture,
    MatrixMode,
    ListBase,
    // Matrices
    MatrixLoad,
    MatrixChange,
    MatrixPush,
    MatrixPop,
    AttribPush,
    AttribPop,
    ClientPush,
    ClientPop,
    // Objects
    Gen,
    Create,
    GenLists,
    Delete,
    DeleteList,
    Bind,
    BindIndexed,
    UseProgram,
    ArrayPointer,
    ArraySet,
    ArrayNamedSet,
    BufferData,
    BufferSubData,
    BufferOther,
    TexParameter,
    TexImage,
    TexStorage,
    TexSubImage,
    TexCopyImage,
    TexCopySubImage,
    TexMipmaps,
    TexBuffer,
    TexView,
    RenderbufferStorage,
    NamedSet,
    FramebufferAttach,
    FramebufferSet,
    FramebufferNamed,
    DrawBuffers,
    ShaderSet,
    ShaderCompile,
    ProgramAttach,
    ProgramDetach,
    ProgramSet,
    ProgramLink,
    ProgramDelete,
    ShaderDelete,
    Uniform,
    ProgramUniform,
    PipelineSet,
    ArbProgram,
    SyncMake,
    SyncDelete,
    Handle,
    HandleResident,
    TexPages,
    BufferPages,
    // Pictures
    Draw,
    Compute,
    ReadsPicture,
    Clear,
    ClearBuffer,
    Blit,
    Barrier,
    Begin,
    Vertex,
    End,
    NewList,
    EndList,
    CallList,
    CallLists,
    QueryBegin,
    QueryEnd,
    QueryCounter,
    FeedbackBegin,
    FeedbackEnd,
    ConditionalEnd,
};

// The type of the named object, where the effect leaves it open.
enum class ObjectType : uint8_t {
    None,
    Texture,
    Buffer,
    Framebuffer,
    Renderbuffer,
    VertexArray,
    Query,
    Sampler,
    Program,
    Pipeline,
    Feedback,
    ArbProgram,
    List,
    Sync
};

// Handling of uploads that are deferred until a command may read them (streamcodec/filter/command_class.hpp).
enum class Deferral : uint8_t {
    ByEffect,
    Bind,    // changes bindings
    Object,  // sends the uploads of its object first
    UseAll,  // may read any object of the share group
    Unknown, // may do anything
};

// No bit of glPushAttrib saves the state, not even GL_ALL_ATTRIB_BITS. GL does not use bit 31.
constexpr uint32_t kNoAttribBit = 0x80000000;

struct CommandEffect {
    EffectKind kind = EffectKind::Unknown;
    ObjectType object = ObjectType::None;
    Deferral deferral = Deferral::ByEffect;
    uint32_t attribBits = 0; // bits of glPushAttrib that certainly save the state; 0: unknown
};

// By opcode.
extern const std::array<CommandEffect, op::kLimit> kCommandEffects;

} // namespace mural
