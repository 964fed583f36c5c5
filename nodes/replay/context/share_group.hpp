// Objects and state that the contexts of one share group have in common on this node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "gl_functions.hpp"
#include "nodes/replay/engine/handle_table.hpp"
#include "nodes/replay/engine/name_table.hpp"
#include "nodes/replay/features/culling_state.hpp"
#include "nodes/replay/features/list_sections.hpp"
#include "nodes/replay/features/projection_detection.hpp"
#include "nodes/replay/programs/program_rewriter.hpp"
#include "nodes/replay/programs/program_sources.hpp"

namespace mural {

class AsyncReadback;

namespace replay {

struct ProgramInfo {
    std::unordered_map<GLint, GLint> locations; // from the program's to this node's, only where they differ
};

// One part of a display list of the program.
struct DisplayListItem {
    GLuint native = 0;                         // this node's list with the commands of the item; 0: none
    uint32_t vertices = 0;                     // approximate number that the native list draws
    bool plain = true;                         // changes no state that decides whether draws may be shared
    std::vector<std::byte> record;             // a command that the node executes itself; empty: native
    std::vector<std::vector<std::byte>> blobs; // blobs of the record
    // of a native list that culling may leave out; null: it has other commands
    std::shared_ptr<const ListedPrimitives> primitives;
    unsigned cullingChanges = 0; // parts of CullingState that the native list changes
};

struct DisplayList {
    std::vector<DisplayListItem> items;
};

// The objects of a texture handle that this node's driver returned. Names of this node.
struct ObtainedHandle {
    GLuint texture, sampler; // sampler: the program's, or 0
    GLuint made;             // an equal sampler that was created to obtain the handle, or 0
};

struct ShareGroup {
    NameTable tables[static_cast<int>(Kind::Count)];
    std::unordered_map<uint64_t, GLsync> syncs;
    std::unordered_map<GLuint, ProgramInfo> programs; // by the program's name
    std::unordered_map<GLuint, DisplayList> lists;
    NameTable framebuffersOfAll;
    // by this node's shader name: contains a module that reads gl_FragCoord
    std::unordered_map<GLuint, bool> placedModules;
    bool listsContainBitmaps = false;              // at least one list contains a bitmap
    bool texturesHaveLevels = false;               // at least one texture has (features/whole_windows.cpp)
    bool testsDepth = false, testsStencil = false; // some command or list has enabled the test
    // every node draws everything: the program's side requested it, or a module reads gl_FragCoord
    bool allDrawn = false;
    ProgramRewriter tiled;
    ProgramSourcesStore recipes;
    HandleTable handles;
    std::unordered_map<uint64_t, ObtainedHandle> textureHandles; // by the program's texture handle
    bool handlesFreed = false;                                   // some texture with a handle was deleted
    std::unordered_map<GLuint, ProjectionDetector> projections;  // by the program's name (features/stereo_view.cpp)
    // by this node's program name: numbers primitives, so draws are not cut into pieces
    std::unordered_map<GLuint, bool> primitiveIds;
    // by the program's name, after its first use (features/draw_skipping.cpp)
    std::unordered_map<GLuint, bool> memoryWriters;
    CullingGroup culling;
    ProjectionDetector projection;        // the last one found in any buffer
    std::shared_ptr<AsyncReadback> later; // null: unavailable, or not requested yet
    bool asyncTried = false;              // creation was tried once
};

} // namespace replay

} // namespace mural
