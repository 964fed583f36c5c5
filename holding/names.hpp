// What is followed of a program: which objects its commands name, and nothing else.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "holding/cells.hpp"
#include "holding/frame_layout.hpp"
#include "holding/name_index.hpp"
#include "holding/object.hpp"
#include "holding/small_state.hpp"

namespace mural::holding {

constexpr size_t kTextureTargets = 12;
using TextureUnit = std::array<Object*, kTextureTargets>; // by targetIndex()

struct Context;

struct ListNames {
    bool binds = false; // changes what is bound, or is not understood: a call of it ends holding
    bool calls = false; // other lists
    bool sets = false;  // small state, or is not understood
};

// Contexts that share objects. What is held has been sent to one of them, as long as no other says anything.
struct Group {
    std::array<std::unordered_map<uint32_t, std::unique_ptr<Object>>, 3> objects; // by Kind
    std::array<NameIndex<Object>, 3> named;                                       // the same
    std::unordered_map<uint32_t, ListNames> lists;
    bool listsBind = false;    // some of them
    std::vector<Object*> held; // with a queue, in the order in which they got it
    SoonUsed soonUsed;
    uint64_t heldChanges = 0;   // something began to wait, or no longer does
    uint64_t objectChanges = 0; // so often there were others
    Context* holder = nullptr;
    uint32_t holderStream = 0;
    uint64_t frame = 0;
    bool untracked = false; // something has come of which nobody here knows what it does: nothing is held any more
};

struct VertexArray {
    std::vector<std::pair<uint32_t, Object*>> buffers; // by command and index
    Object* indices = nullptr;
    bool operator==(const VertexArray&) const = default;
};

// What a context has bound.
struct Bindings {
    std::vector<TextureUnit> units = std::vector<TextureUnit>(1);
    uint32_t unit = 0, clientUnit = 0;
    std::vector<std::pair<uint32_t, Object*>> buffers; // by target, but those of indices
    std::unordered_map<uint32_t, VertexArray> arrays{{0, {}}};
    VertexArray* array = &arrays[0]; // of the context's, in a copy too
    Object* program = nullptr;
    bool programSure = true; // false: whether it is the current one is not known
    uint32_t drawFramebuffer = 0;
    bool operator==(const Bindings&) const = default;
    [[nodiscard]] bool equalButTextures(const Bindings& other) const {
        return units.size() == other.units.size() && unit == other.unit && clientUnit == other.clientUnit && buffers == other.buffers && arrays == other.arrays && array == other.array &&
               program == other.program && programSure == other.programSure && drawFramebuffer == other.drawFramebuffer;
    }
    // Of a context, what it had bound when it had as many vertex arrays as now.
    void takeOver(const Bindings& before) {
        units = before.units;
        unit = before.unit, clientUnit = before.clientUnit;
        buffers = before.buffers;
        for (const auto& [name, there] : before.arrays) arrays[name] = there;
        array = before.array;
        program = before.program, programSure = before.programSure;
        drawFramebuffer = before.drawFramebuffer;
    }
};

struct SavedAttribs {
    bool textures = false;
    uint32_t unit = 0;
    std::vector<TextureUnit> units;
};

struct SavedClientAttribs {
    uint32_t mask = 0;
    Object* unpackBuffer = nullptr;
};

struct Context : Bindings {
    uint32_t id = 0;
    std::shared_ptr<Group> group;
    bool madeByBinding = false; // names begin to be with their first use
    bool destroyed = false;     // but current
    NameIndex<VertexArray> arraysNamed;
    std::vector<decltype(arrays)::node_type> sparedArrays; // some make their vertex arrays anew for each draw
    std::vector<SavedAttribs> attribs;
    std::vector<SavedClientAttribs> clientAttribs;
    bool needs = true; // something that waits may have been bound since the last draw, or held
    Cells<kStateWords> state; // small state, by StateSet
};

// Frames of a stream that bind what the one before did.
struct SameFrames {
    enum class Now : uint8_t {
        Apart,     // each record is followed
        Recording, // and kept
        Following, // those that are as expected are not: what is bound is as at the frame's beginning, or where layout.follow() stopped
    };
    Now now = Now::Apart;
    FrameLayout layout;
    size_t keptBytes = 0; // of the packet, while a frame is kept
    bool inValue = false; // the last record kept was a piece of one
    const Context* context = nullptr; // of that frame
    uint64_t heldChanges = 0, objectChanges = 0;
    // What the frame of the layout began with, and left. Of textures that may differ: what a frame has left in another state than it began
    // with, it has bound itself, and so does each that is like it, whatever it begins with there.
    Bindings begins, ends;
    std::vector<TextureUnit> began; // what this frame did
    struct Mark {                   // and what one had bound in its midst, a little before the place where another record came
        size_t followed = 0;        // so many records on; 0: there is none
        uint32_t frame = 0;         // in which it was made
        std::vector<TextureUnit> began;
        Bindings bound;
        bool inPrimitive = false;
    } mark;
    uint32_t frames = 0;    // since the layout was kept
    uint32_t wait = kFirst; // so many until the next one is
    double shares = 0;      // of the layout that those frames were like
    static constexpr uint32_t kFirst = 4, kMost = 1024;
};

struct Stream {
    uint32_t id = 0;
    Context* context = nullptr; // current
    bool inPrimitive = false;
    uint32_t list = 0; // that is compiled; 0: none
    ListNames compiled;
    int depth = 0; // glBegin without glEnd in that list
    // A value that travels ahead of its record: what of it came in packets before this one, or all of it went on already.
    std::vector<std::byte> pending;
    uint64_t valueBytes = 0, firstValueBytes = 0;
    uint32_t values = 0, pendingRecords = 0;
    bool passing = false;
    Worth waiting; // whether values were worth being waited for
    SameFrames same;
};

} // namespace mural::holding
