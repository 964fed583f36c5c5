// Drawing with Mural: the tasks of a render node.
//
// A program derives Renderer. Mural creates one object of it on each render node, and calls its tasks for every frame.
// Each task draws one part of the picture: the context of the task states the part of the picture, the range of the
// data, and the eye. Mural combines the parts.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <mural/barrier.hpp>
#include <mural/object_reader.hpp>
#include <mural/queue.hpp>
#include <mural/sharing.hpp>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/geometry/eye.hpp"
#include "common/geometry/frustum.hpp"
#include "common/geometry/matrix4.hpp"
#include "common/geometry/pixel_kernel.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "common/geometry/range.hpp"
#include "common/geometry/sub_pixel.hpp"
#include "common/geometry/vector3.hpp"
#include "common/geometry/viewport.hpp"
#include "common/geometry/zoom.hpp"

namespace mural {

namespace native {
class TaskState;
} // namespace native

// A frame, equal on all nodes. Animations depend on these values only, never on a node's clock or random numbers.
struct Frame {
    uint64_t number = 0; // from 1
    double seconds = 0;  // since the start of the session
    uint64_t seed = 0;   // for pseudo-random numbers; differs from frame to frame
};

// The part of a frame that one task draws. Source: thesis, "Parallel Rendering Architecture": render context.
struct RenderContext {
    PixelViewport area;    // the drawn pixels of `picture`
    PixelViewport picture; // the whole picture; its lower left corner is 0 0
    Viewport part;         // the drawn part, as fractions of the picture
    Range range;           // the drawn part of the data: [start, end) within [0, 1]
    Eye eye = Eye::Cyclop; // stereo
    PixelKernel pixel;     // pixel decomposition: every pixel.w-th column and pixel.h-th row
    SubPixel subPixel;     // sample of an averaged picture
    Zoom zoom;             // size of this picture relative to the shown one
    uint32_t period = 1;   // time-multiplex: this node draws every period-th frame…
    uint32_t phase = 0;    // …beginning with this one
    int node = 0;          // number of the render node
};

// The context that a renderer draws with.
struct GlWish {
    int major = 3;        // lowest version: its first number…
    int minor = 3;        // …and its second
    bool isCore = true;   // core profile; otherwise the compatibility profile
    bool isDebug = false; // debug context
    int samples = 0;      // multisampling; 0: none
    int depthBits = 24;   // lowest number
    int stencilBits = 8;  // lowest number
    // Colours are half floats, from RenderTask::clear to the end of overlay: values above 1 and transparent layers keep
    // their precision, also in By::Over between nodes. Pictures on the wall have 8 bits. Excludes samples.
    bool isHalfFloat = false;
};

// How the parts of several ranges become one picture.
struct Composition {
    // The rule that combines two parts.
    enum class By : uint8_t {
        Depth, // the fragment that passes the depth test
        // Premultiplied colours, blended from back to front by Renderer::order. The part of a range must be convex, and
        // clear() must leave transparent black: a background belongs into overlay().
        Over,
    };
    // The depth test of the renderer's draws.
    enum class DepthTest : uint8_t { Less, LessOrEqual, Greater, GreaterOrEqual };

    By by = By::Depth;                     // rule of the combination
    DepthTest depthTest = DepthTest::Less; // for By::Depth
};

// The GL of a render node, valid from Renderer::start to Renderer::end.
struct Pipe {
    int node = 0;         // number of the render node
    std::string renderer; // GL_RENDERER
    std::string version;  // GL_VERSION
};

// One task of one frame. Valid during the call. The context of the renderer is current; its state is what the previous
// task left.
class RenderTask {
public:
    // The part of the frame, of the data, and the eye that the task draws.
    [[nodiscard]] const RenderContext& context() const;
    // The frame that the task belongs to.
    [[nodiscard]] const Frame& frame() const;

    // Sets the distances of the clipping planes, in units of the scene. Default: 0.1 and 100. Invalid values (near not
    // above 0, far not above near) are ignored. Call it before projection().
    void setNearFar(double nearPlane, double farPlane);
    // The projection of the whole picture, not of this task's part: parts of one picture have one projection, and thus
    // no seams. Includes the pixel kernel, the sample, and the zoom.
    [[nodiscard]] Matrix4 projection() const;
    // Transforms coordinates of the room to coordinates of the eye: the view matrix of shaders.
    [[nodiscard]] Matrix4 toEye() const;
    // The frustum of this task's part alone, in eye coordinates. For culling: everything outside of it is invisible
    // here.
    [[nodiscard]] Frustum cullFrustum() const;

    // Binds the framebuffer, and sets draw buffer, colour mask, viewport and scissor for this part.
    void apply() const;
    // The framebuffer that apply() binds. To return to it from framebuffers of the renderer.
    [[nodiscard]] unsigned framebuffer() const;

    // Whether context and sizes are as in this node's previous frame, so that caches that depend on them hold.
    [[nodiscard]] bool sameAsBefore() const;

    // Returns the state object of the application with this type and name, as it was when the frame began. Valid until
    // the end of the task. A default-constructed T, and one message, if the application has no such object.
    template <class T> [[nodiscard]] const T& state(std::string_view name = {}) const {
        auto found = objects().template stateAt<T>(frame().number, native::stateName(name), Deadline::inMs(0));
        if (found) return *static_cast<const T*>(keep(std::move(*found)));
        reportMissing(found.error().message);
        static const T none{};
        return none;
    }
    // All distributed objects.
    [[nodiscard]] ObjectReader& objects() const;

    // The queue of this name, to which the application adds items (Session::queue()). All calls with one name share the
    // items that the node has received. A lost node's items go to other nodes, so an item may be processed twice.
    template <class T> [[nodiscard]] QueueReader<T> queue(std::string_view name) const {
        return QueueReader<T>(queueAny(name));
    }
    // The barrier of this name. All render nodes are members of every barrier, and so is the application after
    // Session::barrier(). Lost nodes are not waited for. Rounds belong to frames: the n-th call in a frame waits for
    // the n-th calls in that frame. A node without a part of the frame has no tasks, and is missing.
    [[nodiscard]] Barrier barrier(std::string_view name) const;

    explicit RenderTask(native::TaskState& state) : state_(state) {} // internal

private:
    std::shared_ptr<AnyQueueReader> queueAny(std::string_view name) const;
    const void* keep(std::shared_ptr<const void> snapshot) const; // until the end of the task
    void reportMissing(const std::string& problem) const;

    native::TaskState& state_;
};

// Draws. One object per render node; one thread calls everything. An exception that leaves a task is reported once per
// text, and the frame is shown without the rest of the task.
class Renderer {
public:
    virtual ~Renderer() = default;
    // Called once, before start(). Default: OpenGL 3.3 core.
    [[nodiscard]] virtual GlWish wish() const { return {}; }
    // The context is current. Creates programs, buffers and textures. An error ends this node and states the reason.
    virtual Result<void> start(Pipe&) { return {}; }
    // The context is current. Not called if the node is killed, or if its GL is lost.
    virtual void end(Pipe&) {}
    // Called before the tasks of a frame.
    virtual void frameStart(Pipe&, const Frame&) {}
    // Called after them.
    virtual void frameEnd(Pipe&, const Frame&) {}

    // Clears the part. Default: applies the task, and clears colour to 0 and depth to the far value of composition().
    virtual void clear(RenderTask& task);
    // Draws the part of the scene in context().area and context().range. Default: shows the borders of the part, in a
    // colour per node, so that a wall can be set up without a program.
    virtual void draw(RenderTask& task);
    // Draws over the complete picture, on the node that has it. Default: nothing.
    virtual void overlay(RenderTask&) {}

    // How parts of several ranges are combined. Default: by depth, GL_LESS.
    [[nodiscard]] virtual Composition composition() const { return {}; }
    // For Composition::By::Over: the position of a range in the order of blending. A smaller value is nearer to the
    // eye. Must be a pure function of its arguments and of task.state(), because every node evaluates it; waiting for
    // objects here may give another result on one node. Equal values: the lower range is
    // nearer. Default: the start of the range.
    [[nodiscard]] virtual double order(RenderTask&, const Range& range) const { return range.start; }
};

// Compiles and links a program from the texts of a vertex and a fragment shader. Requires a current context. Errors:
// the log of the compiler.
[[nodiscard]] Result<unsigned> linkProgram(std::string_view vertex, std::string_view fragment);
// The matrix in the order of OpenGL: column by column.
[[nodiscard]] std::array<float, 16> glMatrix(const Matrix4& matrix);
// The entry point of a GL command in the current context, or null. For programs that do not link a GL library.
[[nodiscard]] void (*glProc(const char* name))();

// The items of `range` out of `count`: first and end. Neighbouring ranges share no item and leave none out.
[[nodiscard]] inline std::pair<uint64_t, uint64_t> itemsOf(const Range& range, uint64_t count) {
    return {countBefore(range.start, count), countBefore(range.end, count)};
}

// Whether the axis-aligned box is outside of the frustum. `toEye` transforms the box to eye coordinates. Never true for
// a visible box; may be false for an invisible one near an edge.
[[nodiscard]] bool isOutside(const Frustum& frustum, const Matrix4& toEye, const Vector3& lowest,
                             const Vector3& highest);

} // namespace mural
