// Tracked state of the command filter: the objects that commands refer to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streamcodec/filter/state_cache.hpp"
#include "streamcodec/filter/frame_template.hpp"
#include "streamcodec/filter/name_index.hpp"
#include "streamcodec/filter/object.hpp"
#include "streamcodec/filter/state_setters.hpp"

namespace mural::filter {

constexpr size_t kTextureTargets = 12;
using TextureUnit = std::array<Object*, kTextureTargets>; // indexed by targetIndex()

struct Context;

struct ListNames {
    bool binds = false; // changes bindings, or is not understood: calling it disables deferral
    bool calls = false; // calls other lists
    bool sets = false;  // sets state, or is not understood
};

// A share group. Deferred commands belong to one of its contexts; a command of another context flushes them.
struct Group {
    std::array<std::unordered_map<uint32_t, std::unique_ptr<Object>>, 3> objects; // by Kind
    std::array<NameIndex<Object>, 3> named;                                       // by Kind
    std::unordered_map<uint32_t, ListNames> lists;
    bool listsBind = false;        // some display lists change bindings
    std::vector<Object*> deferred; // objects with a queue, oldest first
    SoonUsed soonUsed;
    uint64_t deferredChanges = 0; // number of changes of the set of deferred objects
    uint64_t objectChanges = 0;   // number of changes of the set of objects
    Context* deferringContext = nullptr;
    uint32_t deferringStream = 0;
    uint64_t frame = 0;
    bool untracked = false; // a command with unknown effects was executed: deferral is off
};

struct VertexArray {
    std::vector<std::pair<uint32_t, Object*>> buffers; // by command and index
    Object* indices = nullptr;
    bool operator==(const VertexArray&) const = default;
};

// Bindings of a context.
struct Bindings {
    std::vector<TextureUnit> units = std::vector<TextureUnit>(1);
    uint32_t unit = 0, clientUnit = 0;
    std::vector<std::pair<uint32_t, Object*>> buffers; // by target, except GL_ELEMENT_ARRAY_BUFFER
    std::unordered_map<uint32_t, VertexArray> arrays{{0, {}}};
    VertexArray* array = &arrays[0]; // points into the context's arrays, in a copy too
    Object* program = nullptr;
    bool programSure = true; // false: the current program is unknown
    uint32_t drawFramebuffer = 0;
    bool operator==(const Bindings&) const = default;
    [[nodiscard]] bool equalButTextures(const Bindings& other) const {
        return units.size() == other.units.size() && unit == other.unit && clientUnit == other.clientUnit &&
               buffers == other.buffers && arrays == other.arrays && array == other.array && program == other.program &&
               programSure == other.programSure && drawFramebuffer == other.drawFramebuffer;
    }
    // Restores the bindings of a state with the same number of vertex arrays.
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
    bool madeByBinding = false; // first use of a name creates the object
    bool destroyed = false;     // but still current
    NameIndex<VertexArray> arraysNamed;
    // recycled nodes: some programs recreate vertex arrays for each draw
    std::vector<decltype(arrays)::node_type> sparedArrays;
    std::vector<SavedAttribs> attribs;
    std::vector<SavedClientAttribs> clientAttribs;
    bool needs = true;             // a deferred object may have been bound or deferred since the last draw
    StateCache<kStateWords> state; // state cells, by StateSet
};

// Detects frames of a stream with the bindings of the previous frame.
struct FrameMatcher {
    enum class Now : uint8_t {
        Apart,     // every record is tracked
        Recording, // the same, and a template is built
        Matching,  // matching records are skipped; the bindings stay as at the frame's start, or as after
                   // frameTemplate.track()
    };
    Now now = Now::Apart;
    FrameTemplate frameTemplate;
    size_t templateBytes = 0;         // bytes of the packet in the template that is being built
    bool inValue = false;             // the last record in the template was a piece of a blob
    const Context* context = nullptr; // context of the template
    uint64_t deferredChanges = 0, objectChanges = 0;
    // Bindings at the start and the end of the template. Textures may differ: a frame binds every texture whose binding
    // it changes, and so does every matching frame.
    Bindings begins, ends;
    std::vector<TextureUnit> began; // at the start of this frame
    struct Mark {                   // bindings within the template, slightly before the usual point of difference
        size_t tracked = 0;         // number of records before it; 0: no mark
        uint32_t frame = 0;         // frame in which it was made
        std::vector<TextureUnit> began;
        Bindings bound;
        bool inPrimitive = false;
    } mark;
    uint32_t frames = 0;    // frames since the template was built
    uint32_t wait = kFirst; // frames until the next template
    double shares = 0;      // sum of the matched fractions
    static constexpr uint32_t kFirst = 4, kMax = 1024;
};

struct Stream {
    uint32_t id = 0;
    Context* context = nullptr; // current context
    bool inPrimitive = false;
    uint32_t list = 0; // list in compilation; 0: none
    ListNames compiled;
    int depth = 0; // unmatched glBegin in that list
    // A blob before its record: buffered pieces of earlier packets, unless they were already sent.
    std::vector<std::byte> pending;
    uint64_t valueBytes = 0, firstValueBytes = 0;
    uint32_t values = 0, pendingRecords = 0;
    bool passing = false;
    Worth waiting; // whether buffering blobs pays off
    FrameMatcher same;
};

} // namespace mural::filter
