// Pictures that GL writes into buffers while the replay goes on. Another thread waits for them, and looks at them there, by a context of the same share group.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "gl_functions.hpp"
#include "common/picture_format.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/pictures/picture_read.hpp"

namespace mural {

// Of one share group. Lives as long as pictures of it are on their way, which may be longer than the program's contexts do.
class LaterReads : public std::enable_shared_from_this<LaterReads> {
public:
    LaterReads(std::unique_ptr<gl::SharedReader> reader, const GlFunctions& gl);

    // By the replay's thread, with a context of the group current. The buffer of `bytes` is bound to GL_PIXEL_PACK_BUFFER, and then the picture is read into it.
    void bindBuffer(size_t bytes);
    // What was read; it is drawn when the fence says so. redFirst: R G B A. Null: GL makes no fence.
    std::unique_ptr<PictureRead> take(bool redFirst, PictureFormat format);

private:
    friend class LaterPicture;
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
    Buffer bound_; // the replay's thread alone
    std::mutex mutex_;
    std::vector<Buffer> free_;
};

} // namespace mural
