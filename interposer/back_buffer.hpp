// The window's back buffer in the program's own context, read without leaving a trace: what the program has
// bound and set is put back, and its errors stay its own.
#pragma once

#include <GL/gl.h>

#include "interposer/pixel_store.hpp"

namespace mural {

struct Context;
struct Window;

class BackBufferRead {
public:
    // NodesToo: the nodes are told to read there as well, for a question in between.
    enum class Where { Here, NodesToo };

    BackBufferRead(Context& context, const Window& window, Where where);
    ~BackBufferRead();
    BackBufferRead(const BackBufferRead&) = delete;
    BackBufferRead& operator=(const BackBufferRead&) = delete;

    // False: something is bound that is deleted already and could not be bound again, or the process exits and the driver has
    // freed what reads need; nothing is read.
    [[nodiscard]] bool ready() const { return ready_; }
    // Reads RGBA, tightly packed. Leaves memory of pixels outside the buffer unchanged.
    void pixels(GLint x, GLint y, GLsizei width, GLsizei height, void* into, GLenum type = GL_UNSIGNED_BYTE) const;

private:
    void bindWindow(const Window& window);

    Context& context_;
    Where where_;
    bool ready_ = false;
    GLenum target_;
    GLint framebuffer_ = 0, readBuffer_ = 0;
    TightPack pack_;
};

} // namespace mural
