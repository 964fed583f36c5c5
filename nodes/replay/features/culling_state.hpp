// State of a context on which culling depends: asked of GL once after the commands that may change it, never assumed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "gl_functions.hpp"
#include "nodes/culling/linear_view.hpp"
#include "nodes/culling/tile_planes.hpp"

namespace mural::replay {

struct CullingProgram;

// Contents of buffers and facts about the objects of one share group.
class CullingGroup {
public:
    // A number that no other contents have had. Names are this node's.
    uint64_t contentsOf(GLuint buffer);
    void bufferChanged(GLuint buffer) { contents_.erase(buffer); }
    void anyBufferChanged() { contents_.clear(); }
    // Records that a command, perhaps of a display list, enables `cap`. GL is not asked about caps that it may lack.
    void capSeen(GLenum cap);
    [[nodiscard]] bool hasSeen(GLenum cap) const;

    // A deleted buffer lives on in vertex arrays that are not bound, and in other contexts, while a new buffer may have
    // its name. Arrays of such names are not examined.
    void bufferDeleted(GLuint buffer) { ambiguous_.insert(buffer); }
    void unknownBuffersDeleted() { isAnyAmbiguous_ = true; }
    [[nodiscard]] bool isAmbiguous(GLuint buffer) const {
        return isAnyAmbiguous_ || (!ambiguous_.empty() && ambiguous_.contains(buffer));
    }

    int contexts = 0;             // of the share group
    bool hasVertexArrays = false; // some context has bound one
    uint64_t uniforms = 0;        // changes of uniforms
    uint64_t links = 0;           // changes of programs
    // by this node's name, as of knownLinks
    std::unordered_map<GLuint, std::shared_ptr<CullingProgram>> programs;
    uint64_t knownLinks = 0;

private:
    std::unordered_map<GLuint, uint64_t> contents_;
    std::unordered_set<GLuint> ambiguous_;
    bool isAnyAmbiguous_ = false;
    uint32_t caps_ = 0;
};

// One vertex attribute of the current vertex array.
struct CullingArray {
    bool isEnabled = false, isFloat = true; // isFloat: the shader receives floats
    bool isNormalized = false;
    GLuint buffer = 0; // 0: client memory
    GLuint divisor = 0;
    uint64_t offset = 0, stride = 0;
    GLenum type = 0;
    GLint components = 0;
};

class CullingState {
public:
    enum Part : uint8_t {
        Modelview = 1,
        Projection = 64,
        Matrices = 65,
        Raster = 2,
        Arrays = 4,      // layouts of any vertex array
        VertexArray = 8, // the current vertex array
        IndexBuffer = 16,
        Program = 32,
        All = 255
    };
    // An index buffer belongs to a vertex array.
    void changed(unsigned parts) { dirty_ |= parts | (parts & (Arrays | VertexArray) ? unsigned{IndexBuffer} : 0U); }
    // The matrix of the current mode changes.
    void matrixChanged();
    // The program sets the mode. isCertain: GL executes the command now.
    void setMatrixMode(GLenum mode, bool isCertain) { matrixMode_ = isCertain ? mode : 0; }
    [[nodiscard]] bool isDirty(unsigned part) const { return (dirty_ & part) != 0; }

    struct Facts {
        bool isCore = false, isEs = false;
        bool hasMatrices = false; // of fixed function
        int version = 0;          // major * 10 + minor
        bool hasBindings = false; // ARB_vertex_attrib_binding
        bool hasClipControl = false;
        bool isSoftware = false; // vertices are processed on this machine's CPU
        bool areKnown = false;
    };
    Facts facts;

    // Matrices of fixed function, column-major.
    struct FixedMatrices {
        float projection[16], modelview[16];
    };
    struct RasterState {
        culling::ClipWindow viewport;
        double lineWidth = 1, pointSize = 1;
        bool drawsEdges = false; // polygon mode line or point
        bool isUpsideDown = false;
        bool isArbProgram = false;
        bool restarts = false;
        GLuint restartIndex = 0;
        bool restartsAtLargest = false;

        // Pixels between the edges of an area and its planes, for primitives of `mode`.
        [[nodiscard]] double marginOf(GLenum mode) const;
    };

    const FixedMatrices& matrices(const GlFunctions& gl);
    // Numbers that grow when the state is asked of GL again.
    [[nodiscard]] uint64_t matricesNumber() const { return matricesNumber_; }
    const RasterState& raster(const GlFunctions& gl, const CullingGroup& group);
    [[nodiscard]] uint64_t rasterNumber() const { return rasterNumber_; }
    // The position of fixed function, and generic attributes.
    const CullingArray& position(const GlFunctions& gl);
    const CullingArray& attribute(const GlFunctions& gl, GLuint index);
    GLuint indexBuffer(const GlFunctions& gl);

    // A draw that is left out would have separated the primitives before and after it.
    bool hasPendingPrimitives = false;
    bool isInPrimitive = false; // perhaps: after glBegin

private:
    void selectVertexArray(const GlFunctions& gl);

    struct Layout {
        bool knowsPosition = false;
        CullingArray position;
        std::map<GLuint, CullingArray> attributes;
    };
    unsigned dirty_ = All;
    GLenum matrixMode_ = 0; // 0: unknown
    FixedMatrices matrices_{};
    uint64_t matricesNumber_ = 0, rasterNumber_ = 0;
    RasterState raster_;
    std::unordered_map<GLuint, Layout> layouts_; // by vertex array
    Layout* layout_ = nullptr;
    GLuint indexBuffer_ = 0;
};

} // namespace mural::replay
