// Asynchronous readback: GL writes pictures into buffers while the replay continues. Another thread waits for them and
// maps them, with a second context of the same share group.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "gl_functions.hpp"
#include "common/base/picture_format.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/frame_transfer/picture_read.hpp"

namespace mural {

// Asynchronous readback for one share group. Lives until its last picture has been read, possibly longer than the
// program's contexts.
class AsyncReadback : public std::enable_shared_from_this<AsyncReadback> {
public:
    AsyncReadback(std::unique_ptr<gl::SharedReader> reader, const GlFunctions& gl);

    // Binds a buffer of `bytes` to GL_PIXEL_PACK_BUFFER, as destination of the following read. Must be called on the
    // replay thread with a context of the group current.
    void bindBuffer(size_t bytes);
    // Returns the picture that was read; a fence signals its completion. redFirst: byte order R G B A. Returns null if
    // GL creates no fence.
    std::unique_ptr<PictureRead> take(bool redFirst, PictureFormat format);

private:
    friend class PendingFrame;
    struct Buffer {
        GLuint name = 0;
        size_t bytes = 0;
    };
    void giveBack(Buffer buffer);

    const std::unique_ptr<gl::SharedReader> reader_; // entered by one thread at a time
    struct Functions {
        decltype(GlFunctions::glGenBuffers) genBuffers;
        decltype(GlFunctions::glBindBuffer) bindBuffer;
        decltype(GlFunctions::glBufferData) bufferData;
        decltype(GlFunctions::glMapBufferRange) mapBufferRange;
        decltype(GlFunctions::glUnmapBuffer) unmapBuffer;
        decltype(GlFunctions::glFenceSync) fenceSync;
        decltype(GlFunctions::glClientWaitSync) clientWaitSync;
        decltype(GlFunctions::glDeleteSync) deleteSync;
        decltype(GlFunctions::glFlush) flush;
    };
    const Functions gl_;
    Buffer bound_; // replay thread only
    std::mutex mutex_;
    std::vector<Buffer> free_;
};

} // namespace mural
