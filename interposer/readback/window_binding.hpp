// Binds a window that is not current for a moment, here and on the nodes, so that its buffers can be read.
#pragma once

namespace mural {

struct Context;
struct ThreadState;
struct Window;

// Keeps the window current for drawing and reading in the thread. The destructor binds the previous context and windows
// again. Precondition: the thread has a current context.
class WindowBinding {
public:
    WindowBinding(ThreadState& t, Window& w);
    ~WindowBinding();
    WindowBinding(const WindowBinding&) = delete;
    WindowBinding& operator=(const WindowBinding&) = delete;

    // False: no context can be bound with the window without an error or the loss of another window's buffers.
    [[nodiscard]] bool ready() const { return ready_; }

private:
    Context* contextFor(const Window& w) const;
    bool bind(Context& context, const Window* draw, const Window* read);

    ThreadState& t_;
    Context& before_;
    bool bound_ = false;
    bool ready_ = false;
};

} // namespace mural
