// What kind of command each opcode is, for following what it reads and writes. Commands that no rule names are Unknown.
#pragma once

#include <array>
#include <cstdint>

namespace mural::recording {

enum class Family : uint8_t {
    Unknown,        // may read and write anything
    UnknownNames,   // and may change what later commands mean
    Nothing,        // leaves nothing behind: questions, flushes
    // State of the context, all set anew
    Cell, CellOfMatrix, CellOfAll, UnitCell, UnitCellOfMatrix, Cap, ClientCap, ClientCell, Attribute, Color, Limit, PatternedCell,
    ActiveTexture, ClientActiveTexture, MatrixMode, ListBase,
    // Matrices
    MatrixLoad, MatrixChange, MatrixPush, MatrixPop,
    AttribPush, AttribPop, ClientPush, ClientPop,
    // Objects
    Gen, Create, GenLists, Delete, DeleteList,
    Bind, BindIndexed, UseProgram,
    ArrayPointer, ArraySet, ArrayNamedSet,
    BufferData, BufferSubData, BufferOther,
    TexParameter, TexImage, TexStorage, TexSubImage, TexCopyImage, TexCopySubImage, TexMipmaps, TexBuffer, TexView,
    RenderbufferStorage, NamedSet, FramebufferAttach, FramebufferSet, FramebufferNamed, DrawBuffers,
    ShaderSet, ShaderCompile, ProgramAttach, ProgramDetach, ProgramSet, ProgramLink, ProgramDelete, ShaderDelete, Uniform, ProgramUniform, PipelineSet,
    ArbProgram, SyncMake, SyncDelete,
    Handle, HandleResident, TexPages, BufferPages,
    // Pictures
    Draw, Compute, ReadsPicture, Clear, ClearBuffer, Blit, Barrier,
    Begin, Vertex, End, NewList, EndList, CallList, CallLists,
    QueryBegin, QueryEnd, QueryCounter, FeedbackBegin, FeedbackEnd, ConditionalEnd,
};

// What the command names, where the family leaves that open.
enum class ObjectType : uint8_t { None, Texture, Buffer, Framebuffer, Renderbuffer, VertexArray, Query, Sampler, Program, Pipeline, Feedback, ArbProgram, List, Sync };

struct Rule {
    Family family = Family::Unknown;
    ObjectType type = ObjectType::None;
    uint32_t attribBits = 0; // of glPushAttrib: those that certainly save this state; 0: unknown
    // The words of a record that say which part of the state it is about: scalars that name or count, before the first value of
    // variable size.
    uint8_t selectors = 0;
    std::array<uint8_t, 8> selectorWords{};
};

constexpr uint32_t kNoAttribBit = 0x80000000; // no bit of glPushAttrib saves it, not even GL_ALL_ATTRIB_BITS: bit 31 is none of its own

const Rule& ruleOf(uint16_t opcode);

} // namespace mural::recording
