// Reads the window's back buffer in the program's own context without side effects. It restores the program's bindings
// and state, and preserves the program's errors.
#pragma once

#include <GL/gl.h>

#include "interposer/memory/pixel_store.hpp"

namespace mural {

struct Context;
struct Window;

class BackBufferRead {
public:
    // NodesToo: the nodes bind the window for reading as well, for a request during the read.
    enum class Where { Here, NodesToo };

    BackBufferRead(Context& context, const Window& window, Where where);
    ~BackBufferRead();
    BackBufferRead(const BackBufferRead&) = delete;
    BackBufferRead& operator=(const BackBufferRead&) = delete;

    // Returns false if nothing can be read. A bound object may be deleted already, so it could not be bound again. The
    // process may be exiting, so the driver has freed its read tables.
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
