// Classes of commands for the command filter: one table entry per opcode, so most records pass without examination.
// Derived from the effects of commands (streamcodec/effect_rules.hpp). A command without an effect ends the
// deferral of its share group.
#pragma once

#include <array>
#include <cstdint>

#include "gl_opcodes.hpp"
#include "streamcodec/filter/state_setters.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural::filter {

enum class CommandClass : uint8_t {
    Pass,  // reads no deferred object and does not change the target of uploads
    Blob,  // a piece of a value that precedes its record
    Use,   // draw: may read all bound objects
    Begin, // glBegin: no record may be inserted until glEnd
    End,
    Arrays,  // belongs to the following draw: no record may be inserted in between
    Bind,    // changes bindings, or creates or deletes objects
    Object,  // acts on one object and must stay after its uploads
    Upload,  // may be deferred
    List,    // display lists
    Own,     // one of Mural's own records
    UseAll,  // may read any object of the share group
    Unknown, // unknown effect, also on bindings: disables deferral for the share group from here on
};

// Actions of commands of class Bind: one case of a switch each.
enum class Binding : uint8_t {
    Nothing, // not tracked: renderbuffers, pipelines, samplers, assembly programs
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

// Role of a record in frame matching (filter_frames.cpp), where a frame repeats the previous one.
enum class FrameRole : uint8_t {
    Draws,     // changes no binding, independently of its arguments
    Binds,     // changes bindings or depends on them; its arguments have to match
    Seen,      // examined in each frame
    SeenBound, // examined in each frame with the current bindings
    Ends,      // creates or deletes objects: the frame has no template
};

// Special value of CommandKind::valueWord: no value of variable size.
constexpr uint8_t kNoValue = kNoArgumentWord;

constexpr int8_t kExamined = INT8_MAX;

struct CommandKind {
    CommandClass about = CommandClass::Unknown;
    StateRole state = StateRole::Change;
    EffectKind effect = EffectKind::Unknown;
    uint8_t valueWord = kNoValue; // argument word in which the first value of variable size begins
    bool small = false;           // sets uniforms, which are examined together with redundant state
    // Change of the glBegin nesting depth in a list under compilation. kExamined: the command has other effects, so it
    // must be examined.
    int8_t deeper = kExamined;
    FrameRole frame = FrameRole::Ends;
    Binding binding = Binding::Nothing;
};

// Table of all commands. A loop over records keeps a reference to it, because it looks up every record.
class CommandKinds {
public:
    static const CommandKinds& all();
    const CommandKind& operator[](uint16_t opcode) const { return kinds_[placeOf(opcode)]; }
    // Purpose of a walk over records.
    //   State      redundant state is filtered, or a display list is compiled
    //   Bindings   bindings are tracked; records that bind or draw are examined on the way
    //   Untracked  deferral is disabled
    enum class Walk : uint8_t { State, Bindings, Untracked };
    // Records that a walk may pass. Separate tables, because most records need no other lookup.
    using Interest = wire::RecordWalk::Interest;
    using Interests = std::array<Interest, op::kLimit + 1>;
    [[nodiscard]] const Interests& interests(Walk walk) const { return interests_[static_cast<size_t>(walk)]; }
    static size_t placeOf(uint16_t opcode) { return opcode < op::kLimit ? opcode : op::kLimit; }

private:
    CommandKinds();
    CommandKind kinds_[op::kLimit + 1];
    std::array<Interests, 3> interests_{};
};

inline uint8_t valueWordOf(uint16_t opcode) { return CommandKinds::all()[opcode].valueWord; }

} // namespace mural::filter
