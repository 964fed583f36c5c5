// Programs whose rendering Mural distributes: the application's side.
//
// A program derives Application and Renderer (mural/render.hpp), and calls run() from main(). The user's process runs
// the Application. The same binary runs on every render node, where it runs a Renderer.
//
//   int main(int argc, char** argv) { return mural::run<MyApplication, MyRenderer>(argc, argv); }
//
//   mural run --tiles 4x2 -- ./program
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>
#include <utility>

#include <mural/barrier.hpp>
#include <mural/queue.hpp>
#include <mural/render.hpp>
#include <mural/shared.hpp>
#include <mural/sharing.hpp>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

// The decision of Application::update.
enum class Next : uint8_t {
    Frame, // draw a frame
    Wait,  // draw nothing; update() is called again after a short time
    End,   // end the session
};

struct FrameClock {
    uint64_t frame = 0;   // number of the frame that is being prepared, from 1
    double seconds = 0;   // since the start of the session
    double sinceLast = 0; // since the previous call of update()
};

struct SessionInfo {
    int nodes = 0;             // render nodes at the start
    int width = 0, height = 0; // of the picture, in pixels
};

class Application;

// Makes the two objects of a program.
struct Program {
    std::function<std::unique_ptr<Application>()> application; // called once, in the application's process
    std::function<std::unique_ptr<Renderer>()> renderer;       // called once on each render node
};

// A running session, seen from the application. One thread uses it: that of the Application. Requests of the nodes are
// served by a thread of Mural's.
class Session {
public:
    // Joins the session that started this process. In the process of a render node it runs the node, and ends the
    // process with the node. Outside of a session it starts one: `mural run` with this command line replaces the
    // process. Errors: no session can be joined or started; the reason.
    static Result<std::unique_ptr<Session>> open(int argc, char** argv, const Program& program);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    // The state object of this type and name. Created at the first use, and committed with each frame that changes it.
    // The reference stays valid until the end of the session.
    template <class T> T& state(std::string_view name = {}) {
        const std::string key(name);
        if (AnyState* const found = findState(typeid(T), key)) return static_cast<State<T>&>(*found).value;
        ShareOptions options;
        options.name = native::stateName(name);
        auto made = std::make_unique<State<T>>();
        auto object = shareAny(archive::layoutOf<T>(), options);
        if (object)
            made->shared.emplace(std::move(*object), T());
        else
            made->problem = object.error().message;
        T& value = made->value;
        addState(typeid(T), key, std::move(made));
        return value;
    }
    // A distributed object with a life of its own. Its reference travels in other objects. Errors: the name is too
    // long, too many objects, the session is over.
    template <class T> Result<Shared<T>> share(T value, const ShareOptions& options = {}) {
        auto object = shareAny(archive::layoutOf<T>(), options);
        if (!object) return object.error();
        return Shared<T>(std::move(*object), std::move(value));
    }

    // The queue of this name. Each item goes to one render node, which reads it by RenderTask::queue(). A queue of one
    // frame is closed after its last item, and its name contains the number of the frame.
    template <class T> [[nodiscard]] QueueMaster<T> queue(std::string_view name) {
        return QueueMaster<T>(queueAny(name));
    }
    // The barrier of this name. All render nodes are members of every barrier (RenderTask::barrier()). This call makes
    // the application a member as well; call it in Application::start(), before nodes enter. The application enters for
    // the frame that it has sent last.
    [[nodiscard]] Barrier barrier(std::string_view name);

    // Waits until the nodes are not further behind than the latency of the session permits. Then commits all changed
    // objects, and sends the frame. Returns its number. Errors: the deadline has passed, and nothing was sent; the
    // session is over.
    Result<uint64_t> startFrame(Deadline deadline = Deadline::inMs(10'000));
    // Waits until all nodes have drawn every frame so far. Errors as startFrame().
    Result<void> finishAll(Deadline deadline = Deadline::inMs(10'000));

    // Waits until the deadline, or the end of the session.
    void wait(Deadline deadline);

    // The pose of the observer's head in the room: transforms head coordinates to room coordinates. Belongs to the next
    // frame. A matrix with values that are not finite is ignored.
    void setHead(const Matrix4& pose);

    // The size of the picture, and the number of nodes.
    [[nodiscard]] const SessionInfo& info() const;
    // False after the head has ended the session.
    [[nodiscard]] bool isRunning() const;

private:
    // A state object without its type.
    struct AnyState {
        virtual ~AnyState() = default;
        virtual Result<void> commit(Deadline deadline) = 0;
    };
    template <class T> struct State final : AnyState {
        T value{};
        std::optional<Shared<T>> shared; // empty: see `problem`
        std::string problem;
        Result<void> commit(Deadline deadline) override {
            if (!shared) return Error{problem};
            shared->edit() = value;
            auto committed = shared->commit(deadline);
            if (!committed) return committed.error();
            return {};
        }
    };
    [[nodiscard]] AnyState* findState(std::type_index type, const std::string& name) const;
    void addState(std::type_index type, const std::string& name, std::unique_ptr<AnyState> state);
    std::shared_ptr<AnyQueueMaster> queueAny(std::string_view name);
    Result<std::unique_ptr<SharedObject>> shareAny(const archive::TypeLayout& layout, const ShareOptions& options);

    class Impl;
    explicit Session(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// The application. One object, in the process that the user starts. The main thread calls everything.
class Application {
public:
    virtual ~Application() = default;
    // Reads the command line, before there is a session: --help and wrong options start none. Next::End ends the
    // process with status 0, every other value goes on. An error ends it with status 1. argv lacks Mural's own
    // arguments.
    virtual Result<Next> parse(int /*argc*/, char** /*argv*/) { return Next::Frame; }
    // Called once in a session, with the same arguments. An error ends the session.
    virtual Result<void> start(Session&, int /*argc*/, char** /*argv*/) { return {}; }
    // Prepares a frame by changing objects. Default: waits.
    virtual Next update(Session&, const FrameClock&) { return Next::Wait; }
    // Called last, also after an error.
    virtual void end(Session&) {}
};

// Runs a program until its end. Returns the exit status of the process: 0, 1 after an error of the program, 2 if no
// session could be joined or started.
int run(int argc, char** argv, const Program& program);

// The same with an Application and a Renderer that have default constructors.
template <class App, class Render> int run(int argc, char** argv) {
    return run(argc, argv, {[] { return std::make_unique<App>(); }, [] { return std::make_unique<Render>(); }});
}

} // namespace mural
