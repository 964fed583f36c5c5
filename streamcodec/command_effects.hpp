// Effects of the GL commands: the state that each command reads and writes, for code that tracks a stream.
// Generated from the registry and from options of api/semantics.txt: `effect` and the options after it. Any thread.
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

// State that one command sets as a whole. A later value replaces an earlier one.
enum class StateCell : uint8_t {
    None,
    DepthMask,
    DepthFunc,
    DepthRange,
    ClearDepth,
    StencilMask,
    StencilFunc,
    StencilOp,
    ClearStencil,
    ColorMask,
    ClearColor,
    AlphaFunc,
    BlendFunc,
    BlendEquation,
    BlendColor,
    LogicOp,
    Viewport,
    Scissor,
    CullFace,
    FrontFace,
    PolygonMode,
    PolygonOffset,
    ShadeModel,
    ProvokingVertex,
    PrimitiveRestartIndex,
    LineWidth,
    LineStipple,
    PointSize,
    PixelZoom,
    SampleCoverage,
    MinSampleShading,
    MatrixMode,
};

// The arguments of a command with a cell that every GL accepts.
enum class StateCheck : uint8_t {
    Any,
    Part, // none: the command sets a part of the cell, or the state of one buffer, viewport or face
    Comparison,
    BlendFactors,
    BlendEquations,
    StencilOperations,
    LogicOperation,
    Rectangle, // with a size that is not negative
    Face,
    Winding,
    BothFaces, // polygon modes of both faces
    ShadeModel,
    VertexConvention,
    ThinLine, // forward-compatible contexts refuse wider lines
    Positive,
    MatrixMode,
};

// Compilation into a display list on a node (nodes/replay/engine/object_commands.cpp). The node executes a command that
// depends on its tile, or on the program's names, itself: between two native lists.
enum class ListRole : uint8_t {
    Native,
    Split,
    SplitForScissor,  // if the argument is GL_SCISSOR_TEST
    SplitForAlpha,    // if some window has an alpha channel that the program did not request
    SplitForViewport, // if the node changes viewports
    SplitForTile,     // in lean tiling
};

// No bit of glPushAttrib saves the state, not even GL_ALL_ATTRIB_BITS. GL does not use bit 31.
constexpr uint32_t kNoAttribBit = 0x80000000;

// Arguments of a draw whose vertices may be divided, as words of the record; 0: none. Other draws have no count.
struct DrawWords {
    uint8_t count = 0, first = 0, type = 0, indices = 0, instances = 0;
    uint8_t base = 0; // added to each index; its word, if the indices are an offset
    bool operator==(const DrawWords&) const = default;
};

// The default of each member is 0, because GCC 12 sets all bytes of the table to 0 for commands that are never sent.
struct CommandEffect {
    EffectKind kind = EffectKind::Unknown;
    ObjectType object = ObjectType::None;
    Deferral deferral = Deferral::ByEffect;
    uint32_t attribBits = 0; // bits of glPushAttrib that certainly save the state; 0: unknown
    StateCell cell = StateCell::None;
    StateCheck check = StateCheck::Any;
    ListRole list = ListRole::Native;
    // The last object that the arguments name, other than the changed one: the number of its word from 1; 0: none. The
    // word is a scalar, or begins a value with names.
    uint8_t nameNumber = 0;
    uint8_t dimensions = 0; // of images with several: their number
    DrawWords draw{};
    bool operator==(const CommandEffect&) const = default;
};

// By opcode.
extern const std::array<CommandEffect, op::kLimit> kCommandEffects;

inline const CommandEffect& effectOf(uint32_t opcode) {
    static constexpr CommandEffect kNone;
    return opcode < op::kLimit ? kCommandEffects[opcode] : kNone;
}

} // namespace mural
