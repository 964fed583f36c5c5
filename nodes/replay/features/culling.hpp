// Leaves out vertices that cannot touch this node's area (docs/architecture/culling.md). Parts of the decision that
// several files share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "nodes/culling/box_cache.hpp"
#include "nodes/culling/culling_counts.hpp"
#include "nodes/culling/draw_cut.hpp"
#include "nodes/culling/slice_view.hpp"
#include "nodes/culling/tile_planes.hpp"
#include "nodes/replay/features/culling_state.hpp"
#include "nodes/replay/features/list_sections.hpp"
#include "nodes/session/culling_mode.hpp"

namespace mural::replay {

// A draw from arrays, as its record describes it.
struct CullingDraw {
    GLenum mode = 0;
    uint64_t count = 0, instances = 1;
    int64_t first = 0;                  // first vertex, or the number added to each index
    GLenum indexType = 0;               // 0: no indices
    uint64_t indexOffset = 0;           // in the index buffer; the address of indices in client memory
    std::span<const std::byte> indices; // in client memory; empty: none, or in a buffer
};

// The boxes of a draw; null: it is drawn whole.
struct FoundBoxes {
    std::shared_ptr<const culling::DrawBoxes> boxes;
    culling::Payoff* payoff = nullptr; // of its attempts
    bool isStreamed = false;           // made for this draw alone
};

[[nodiscard]] inline uint32_t indexBytesOf(GLenum type) {
    return type == GL_UNSIGNED_INT ? 4 : type == GL_UNSIGNED_SHORT ? 2 : type == GL_UNSIGNED_BYTE ? 1 : 0;
}

// How the position of a program's vertices depends on uniforms and attributes.
struct CullingProgram {
    struct Uniform {
        GLint location = -1;              // -1: a matrix of fixed function
        bool isModelview = false;         // of these matrices
        std::vector<uint32_t> components; // of the value of GL…
        std::vector<uint32_t> places;     // …and their places in the slice's uniforms
    };
    struct Input {
        size_t attribute = 0; // in `attributes`
        uint32_t component = 0;
    };
    std::optional<culling::SliceView> view; // null: no slice
    std::string reason;                     // for the log
    bool mayCut = false;                    // no stage numbers primitives or draws
    std::vector<Uniform> uniforms;
    std::vector<GLint> attributes; // locations; -1: the position of fixed function
    std::vector<Input> inputs;     // of the slice
};

// One per node.
struct Culling {
    explicit Culling(CullingMode m, const std::string& plant)
        : mode(m),
          plantsMargin(plant == "cullmargin"),
          plantsMatrix(plant == "cullmatrix"),
          plantsContents(plant == "cullcontents"),
          plantsLists(plant == "culllists") {}

    CullingMode mode;
    bool plantsMargin;   // planted fault: areas are too small
    bool plantsMatrix;   // planted fault: each draw uses the view of the draw before it
    bool plantsContents; // planted fault: changes of buffers are not seen
    bool plantsLists;    // planted fault: matrices that lists change are not seen
    culling::BoxCache boxes;
    // Draws whose vertices change with each draw, by the hash of their layout.
    struct StreamedDraw {
        uint32_t sightings = 0;
        culling::Payoff payoff;
    };
    std::unordered_map<uint64_t, StreamedDraw> streamed;
    // of the current draw
    std::vector<culling::VertexRange> ranges;
    std::vector<CullingArray> arrays;
    GLuint auditQuery = 0;
};

// The planes for the draws of a context, as long as nothing that they depend on changes.
struct CullingPlanes {
    GLuint program = 0;            // this node's name; 0: fixed function
    uint64_t view = 0, raster = 0; // numbers of the state
    uint64_t uniforms = 0, links = 0;
    size_t components = 0; // of all arrays
    PixelViewport area;
    double margin = 0;
    std::optional<culling::LinearView> linear; // of the program's inputs
    std::optional<culling::TilePlanes> planes; // null: the view is not linear
};

// State and planes for the draws of one context.
struct ContextCulling {
    CullingState state;
    ListSection section;         // the native list in compilation
    unsigned sectionChanges = 0; // parts of the state that its commands change
    CullingPlanes planes;
};

} // namespace mural::replay
