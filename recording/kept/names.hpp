// What is followed of a program's state: what later commands name (bindings, stacks), and what its objects are made of, as far as
// it decides which commands replace what others have done.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "recording/kept/families.hpp"
#include "recording/kept/key_tree.hpp"
#include "streamcodec/wire.hpp"

namespace mural::recording {

// Kinds of keys. Those of state cells are opcodes, above all of these.
enum class Part : uint32_t {
    Client = 1, State, Pictures, Results, Images, Group, Context, Window, Stream, Owner, Made, First, Config, Picture, Front, Color, Depth, Stencil,
    Object, Name, Storage, Level, Data, Box, Mipmaps, Compiled, Linked, Uniforms, Layout, Attachments, Binding, TextureUnit, ActiveUnit, ClientUnit, MatrixMode, ListBase,
    Matrices, Matrix, MatrixLevel, MatrixValue, AttribLevel, ClientAttribLevel, Conditional, Feedback, QueryKnown, Cells, Arrays, ColorMaterial, MaterialMode,
    Resident, Pages,
};

struct Extent {
    uint32_t width = 0, height = 0, depth = 1;
    bool operator==(const Extent&) const = default;
};

// Of a texture, or of an image of one: their numbers are not each other's.
struct HandleId {
    bool ofImage = false;
    uint64_t value = 0;
    auto operator<=>(const HandleId&) const = default;
};

struct Object;

struct Attachment {
    Object* object = nullptr;
    uint64_t level = 0;  // face << 32 | level
    bool whole = true;   // of the level; false: a layer of it
};

struct Object {
    ObjectType type = ObjectType::None;
    uint32_t name = 0;
    Key key = kNoKey, images = kNoKey; // images: of textures and renderbuffers
    bool made = false;    // something that stays has made it
    bool deleted = false; // its name is free, but others hold it
    bool opaque = false;  // what it is made of, or who shares it, is not known
    uint32_t holders = 0; // bindings and objects that keep it alive
    uint32_t target = 0;  // texture
    std::map<uint64_t, Extent> levels; // texture, by face << 32 | level; renderbuffer: 0
    uint64_t sizeBytes = 0;            // buffer
    std::map<uint32_t, Attachment> attachments; // framebuffer
    std::vector<uint32_t> drawBuffers;          // framebuffer
    std::map<uint64_t, Object*> holds;          // shaders of a program, buffers of a vertex array
    std::vector<std::byte> records;             // of a display list: what of it a call does, but for repetitions
    bool stacks = false;                        // a display list that pushes or pops
    std::set<uint32_t> units;                   // texture units that a program may have been told
    bool anyUnit = false;                       // of a program or shader: it may name them itself
    bool sparse = false;                        // texture, buffer: what is written depends on which pages there are
    std::set<HandleId> handles;                 // of a texture
};

using Objects = std::unordered_map<uint64_t, std::unique_ptr<Object>>; // type << 32 | name

struct Group {
    Key key = kNoKey, images = kNoKey;
    uint32_t contexts = 0;
    bool untracked = false; // a command has come of which nobody here knows what it does with objects
    Objects objects;
    std::vector<std::unique_ptr<Object>> gone; // deleted ones that are held
    std::map<HandleId, uint32_t> handles;      // names of textures
    uint32_t lives = 0;
};

// Switches that decide what commands write, and what limits clears.
struct Limits {
    bool scissor = false, discard = false, conditional = false, unknown = false;
    bool colorMaterial = false; // colours are materials, too
    bool colorMasked = false, alphaMasked = false, depthMasked = false, stencilMasked = false;
    uint32_t drawBuffer = 0x0405; // of windows: GL_BACK
};

struct SavedAttribs { // glPushAttrib
    uint32_t mask = 0;
    Key key = kNoKey;
    uint32_t unit = 0, clientUnit = 0, matrixMode = 0, listBase = 0;
    Limits limits;
    uint64_t colorMaterialMode = 0;
    bool texturesTouched = false; // since then: units, bindings, textures themselves
    std::vector<std::pair<uint64_t, uint32_t>> bindings; // by their slots: names
    std::vector<std::pair<Key, uint32_t>> touched;       // since then, and the bits that save them
};

struct ContextNames {
    Key key = kNoKey, cells = kNoKey;
    std::shared_ptr<Group> group;
    wire::Api api = wire::Api::Desktop;
    bool everCurrent = false, current = false;
    bool unknown = false;    // what commands name, nobody here knows any more
    uint32_t lastStream = 0; // where it was current last
    bool depthTested = false, stencilTested = false, transfersPixels = false; // at any time
    uint64_t colorMaterialMode = 0;
    Objects own; // objects that are not shared
    uint32_t lives = 0;
    std::map<uint64_t, Object*> bindings;
    uint32_t unit = 0, clientUnit = 0, matrixMode = 0x1700, listBase = 0;
    std::map<uint64_t, uint32_t> matrixDepths;
    std::vector<SavedAttribs> attribs, clientAttribs;
    Limits limits;
    std::map<uint64_t, Object*> queries;   // that count now, by target and index
    bool feedback = false;
    std::map<HandleId, bool> resident;     // shaders may take these textures, and write those images
    uint32_t callDepth = 0;
    bool restUnsafe = false; // a list is called that pushes or pops, or calls others
    bool gathersBitmaps = false; // the driver may hold some back
    bool usesFront = false; // it has drawn to, or read from, another buffer of a window than the back
};

struct WindowNames {
    Key key = kNoKey, picture = kNoKey;
    wire::WindowConfig config{};
};

struct StreamNames {
    Key key = kNoKey;
    uint32_t context = 0, draw = 0, read = 0;
    // Of the command that is being put together: glBegin … glEnd, glNewList … glEndList, values and arrays ahead of a draw.
    bool inPrimitive = false, expectsDraw = false;
    uint32_t list = 0;         // that is being compiled; 0: none
    bool listExecutes = false;
    std::vector<std::byte> listRecords;
    bool listStacks = false;
    std::vector<std::byte> rest; // what has to be set behind the command
    std::vector<uint64_t> blobBytes; // of values that no record has taken yet
};

struct ClientNames {
    // state: all that draws depend on, but pictures; results: what only questions and conditions depend on
    Key key = kNoKey, state = kNoKey, pictures = kNoKey, results = kNoKey;
    std::map<uint32_t, ContextNames> contexts;
    std::map<uint32_t, WindowNames> windows;
    uint32_t lives = 0;
};

} // namespace mural::recording
