// State of the GL state tracker: bindings and stacks that later commands refer to, and the structure of objects as far
// as it determines which commands replace others.
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

#include "streamcodec/effect_rules.hpp"
#include "streamcodec/snapshot/key_tree.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::snapshot {

// Kinds of keys. Kinds of state cells are opcodes, which are larger.
enum class Part : uint32_t {
    Client = 1,
    State,
    Pictures,
    Results,
    Images,
    Group,
    Context,
    Window,
    Stream,
    Owner,
    Made,
    First,
    Config,
    Picture,
    Front,
    Color,
    Depth,
    Stencil,
    Object,
    Name,
    Storage,
    Level,
    Data,
    Box,
    Mipmaps,
    Compiled,
    Linked,
    Uniforms,
    Layout,
    Attachments,
    Binding,
    TextureUnit,
    ActiveUnit,
    ClientUnit,
    MatrixMode,
    ListBase,
    Matrices,
    Matrix,
    MatrixLevel,
    MatrixValue,
    AttribLevel,
    ClientAttribLevel,
    Conditional,
    Feedback,
    QueryKnown,
    Cells,
    Arrays,
    ColorMaterial,
    MaterialMode,
    Resident,
    Pages,
};

struct Extent {
    uint32_t width = 0, height = 0, depth = 1;
    bool operator==(const Extent&) const = default;
};

// A texture handle or an image handle: separate number spaces.
struct HandleId {
    bool ofImage = false;
    uint64_t value = 0;
    auto operator<=>(const HandleId&) const = default; // NOLINT(modernize-use-nullptr): no pointer
};

struct Object;

struct Attachment {
    Object* object = nullptr;
    uint64_t level = 0; // face << 32 | level
    bool whole = true;  // of the level; false: a layer of it
};

struct Object {
    ObjectType type = ObjectType::None;
    uint32_t name = 0;
    Key key = kNoKey, images = kNoKey;          // images: of textures and renderbuffers
    bool made = false;                          // created by a command that stays in the log
    bool deleted = false;                       // its name is free, but other objects hold it
    bool opaque = false;                        // its contents, or the objects that share it, are not known
    uint32_t refCount = 0;                      // bindings and objects that keep it alive
    uint32_t target = 0;                        // texture
    std::map<uint64_t, Extent> levels;          // texture, by face << 32 | level; renderbuffer: 0
    uint64_t sizeBytes = 0;                     // buffer
    std::map<uint32_t, Attachment> attachments; // framebuffer
    std::vector<uint32_t> drawBuffers;          // framebuffer
    std::map<uint64_t, Object*> references;     // shaders of a program, buffers of a vertex array
    std::vector<std::byte> records;             // display list: effects of a call, without repetitions
    bool stacks = false;                        // display list that pushes or pops
    std::set<uint32_t> units;                   // texture units that may have been assigned to a program's samplers
    bool anyUnit = false;                       // program or shader that may assign units itself
    bool sparse = false;                        // texture or buffer whose writes depend on committed pages
    std::set<HandleId> handles;                 // of a texture
};

using Objects = std::unordered_map<uint64_t, std::unique_ptr<Object>>; // key: type << 32 | name

struct Group {
    Key key = kNoKey, images = kNoKey;
    uint32_t contexts = 0;
    bool trackingDisabled = false; // an unsupported command may have modified objects: tracking is off for this group
    Objects objects;
    std::vector<std::unique_ptr<Object>> gone; // deleted objects that are still held
    std::map<HandleId, uint32_t> handles;      // texture names
    uint32_t incarnations = 0;
};

// State that decides what commands write, and what limits clears.
struct Limits {
    bool scissor = false, discard = false, conditional = false, unknown = false;
    bool colorMaterial = false; // colours also set the material
    bool colorMasked = false, alphaMasked = false, depthMasked = false, stencilMasked = false;
    uint32_t drawBuffer = 0x0405; // of windows: GL_BACK
};

struct SavedAttribs { // one level of glPushAttrib
    uint32_t mask = 0;
    Key key = kNoKey;
    uint32_t unit = 0, clientUnit = 0, matrixMode = 0, listBase = 0;
    Limits limits;
    uint64_t colorMaterialMode = 0;
    bool texturesTouched = false;                        // units, bindings or textures changed since then
    std::vector<std::pair<uint64_t, uint32_t>> bindings; // slot, name
    std::vector<std::pair<Key, uint32_t>> touched;       // keys changed since then, and the bits that save them
};

struct ContextNames {
    Key key = kNoKey, cells = kNoKey;
    std::shared_ptr<Group> group;
    wire::Api api = wire::Api::Desktop;
    bool everCurrent = false, current = false;
    bool unknown = false;                                                     // bindings are no longer known
    uint32_t lastStream = 0;                                                  // stream in which it was last current
    bool depthTested = false, stencilTested = false, transfersPixels = false; // at any time in the past
    uint64_t colorMaterialMode = 0;
    Objects own; // objects that are not shared
    uint32_t incarnations = 0;
    std::map<uint64_t, Object*> bindings;
    uint32_t unit = 0, clientUnit = 0, matrixMode = 0x1700, listBase = 0;
    std::map<uint64_t, uint32_t> matrixDepths;
    std::vector<SavedAttribs> attribs, clientAttribs;
    Limits limits;
    std::map<uint64_t, Object*> queries; // active queries, by target and index
    bool feedback = false;
    std::map<HandleId, bool> resident; // shaders may sample these textures, and write those images
    uint32_t callDepth = 0;
    bool restUnsafe = false;     // calls a list that pushes, pops, or calls others
    bool gathersBitmaps = false; // the driver may batch bitmaps
    bool usesFront = false;      // has drawn to or read from a window buffer other than the back
};

struct WindowNames {
    Key key = kNoKey, picture = kNoKey;
    wire::WindowConfig config{};
};

struct StreamNames {
    Key key = kNoKey;
    uint32_t context = 0, draw = 0, read = 0;
    // Incomplete command: glBegin ... glEnd, glNewList ... glEndList, blobs and arrays before a draw.
    bool inPrimitive = false, expectsDraw = false;
    uint32_t list = 0; // list in compilation; 0: none
    bool listExecutes = false;
    std::vector<std::byte> listRecords;
    bool listStacks = false;
    std::vector<std::byte> sideEffects; // side effects to set after the command
    std::vector<uint64_t> blobBytes;    // sizes of blobs that no record has consumed yet
};

struct ClientNames {
    // state: everything that draws depend on, except pictures; results: everything that only queries and conditions
    // depend on.
    Key key = kNoKey, state = kNoKey, pictures = kNoKey, results = kNoKey;
    std::map<uint32_t, ContextNames> contexts;
    std::map<uint32_t, WindowNames> windows;
    uint32_t incarnations = 0;
};

} // namespace mural::snapshot
