// What holding back uploads has to know of each command, in one byte: most need no look at all. Made from the families of
// recording/kept, so that there is one table of commands; what that does not know ends holding back.
#pragma once

#include <array>
#include <cstdint>

#include "gl_opcodes.hpp"
#include "holding/small_state.hpp"
#include "recording/kept/families.hpp"
#include "recording/record_walk.hpp"

namespace mural::holding {

enum class CommandClass : uint8_t {
    Pass,    // neither uses what may be held nor changes what uploads are about
    Blob,    // a piece of a value that travels ahead of its record
    Use,     // draws: may use all that is bound
    Begin,   // glBegin: up to glEnd nothing can be put between
    End,
    Arrays,  // belongs to the draw behind it: nothing may come between
    Bind,    // changes what is bound, or what objects there are
    Object,  // does something to one object that has to stay behind its uploads
    Upload,  // may be held
    List,    // display lists
    Own,     // one of Mural's
    UseAll,  // may use anything of the share group
    Unknown, // may do anything, also to what is bound: from there on nothing of the share group is held
};

// What those of class Bind do, one jump for each of them.
enum class Binding : uint8_t {
    Nothing, // that is followed: renderbuffers, pipelines, samplers, programs of assembly
    Unit,
    ClientUnit,
    Texture,
    Buffer,
    VertexArray,
    Framebuffer,
    Program,
    Pointer,
    Indexed,
    Cap,
    ArrayBuffers,
    PushAttribs,
    PopAttribs,
    PushClientAttribs,
    PopClientAttribs,
    Generate,
    Delete,
    Attach,
    AttachNamed,
    Pipeline,
    TextureBuffer,
};

// What a record means to a frame that is like the one before.
enum class FrameRole : uint8_t {
    Draws, // binds nothing, whatever its arguments are
    Binds, // or does what depends on what is bound: by its arguments
    Seen,  // looked at each time
    SeenBound, // the same, and what is bound has to be known
    Ends,  // changes which objects there are: no frame is like another
};

// The word of the arguments in which a value of variable size begins, the first; kNoValue: there is none.
constexpr uint8_t kNoValue = 0xff;

constexpr int8_t kLooked = INT8_MAX;

struct CommandKind {
    CommandClass about = CommandClass::Unknown;
    StateRole state = StateRole::Change;
    recording::Family family = recording::Family::Unknown;
    uint8_t valueWord = kNoValue;
    bool small = false; // sets uniforms, which are looked at where small state is
    // While a list is compiled: by how much primitives are nested deeper behind it, if it matters no otherwise; else kLooked.
    int8_t deeper = kLooked;
    FrameRole frame = FrameRole::Ends;
    Binding binding = Binding::Nothing;
};

// All of them. Each record is looked up, so whoever does it for many keeps the reference.
class CommandKinds {
public:
    static const CommandKinds& all();
    const CommandKind& operator[](uint16_t opcode) const { return kinds_[placeOf(opcode)]; }
    // What a walk over records is about: small state is looked at, or a list compiled; what is bound is followed, where those that bind or draw
    // are looked at on the way; or nothing is held any more.
    enum class Walk : uint8_t { State, Bindings, Untracked };
    // Which it may pass. Tables of their own, as most records are asked for nothing else.
    using Interest = recording::RecordWalk::Interest;
    using Interests = std::array<Interest, op::kLimit + 1>;
    [[nodiscard]] const Interests& interests(Walk walk) const { return interests_[static_cast<size_t>(walk)]; }
    static size_t placeOf(uint16_t opcode) { return opcode < op::kLimit ? opcode : op::kLimit; }

private:
    CommandKinds();
    CommandKind kinds_[op::kLimit + 1];
    std::array<Interests, 3> interests_{};
};

inline uint8_t valueWordOf(uint16_t opcode) { return CommandKinds::all()[opcode].valueWord; }

} // namespace mural::holding
