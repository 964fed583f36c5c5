#include "nodes/replay/readback/async_readback.hpp"

#include <algorithm>
#include <cstring>

#include "nodes/frame_transfer/bgra_swizzle.hpp"

namespace mural {

namespace {

constexpr int64_t kSliceNs = kNsPerS; // longest single wait for a fence

} // namespace

// One picture. bytes() and the destructor must run on the same thread.
class PendingFrame final : public PictureRead {
public:
    PendingFrame(std::shared_ptr<AsyncReadback> of, AsyncReadback::Buffer buffer, GLsync drawn, bool redFirst,
                 PictureFormat format)
        : of_(std::move(of)), buffer_(buffer), drawn_(drawn), redFirst_(redFirst), format_(format) {}
    PendingFrame(const PendingFrame&) = delete;
    PendingFrame& operator=(const PendingFrame&) = delete;
    ~PendingFrame() override {
        if (!entered_) entered_ = of_->reader_->enter().ok();
        if (entered_) {
            if (mapped_) unmap();
            of_->gl_.deleteSync(drawn_);
            of_->reader_->leave();
        }
        of_->giveBack(buffer_);
    }

    [[nodiscard]] Result<std::span<const std::byte>> bytes(Deadline deadline) override {
        if (auto entered = of_->reader_->enter(); !entered) return entered.error();
        entered_ = true;
        GLenum state = GL_TIMEOUT_EXPIRED;
        do state = of_->gl_.clientWaitSync(drawn_, 0, static_cast<GLuint64>(deadline.leftNs(kSliceNs)));
        while (state == GL_TIMEOUT_EXPIRED && !deadline.passed());
        if (state == GL_TIMEOUT_EXPIRED)
            return Error{"the GL did not draw it in time, so the driver may hang; check the system log"};
        if (state == GL_WAIT_FAILED) return Error{"the GL cannot report its completion; use --readback direct"};
        of_->gl_.bindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name);
        mapped_ =
            of_->gl_.mapBufferRange(GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(buffer_.bytes), GL_MAP_READ_BIT);
        if (!mapped_) return Error{"the GL cannot map the buffer of the readback; use --readback direct"};
        const auto* pixels = static_cast<const std::byte*>(mapped_);
        if (!redFirst_) return std::span(pixels, buffer_.bytes);
        swapped_.resize(buffer_.bytes);
        swapRedAndBlue(format_, pixels, swapped_.data(), swapped_.size() / 4);
        return std::span<const std::byte>(swapped_);
    }

private:
    void unmap() {
        of_->gl_.unmapBuffer(GL_PIXEL_PACK_BUFFER);
        of_->gl_.bindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    }

    const std::shared_ptr<AsyncReadback> of_;
    const AsyncReadback::Buffer buffer_;
    const GLsync drawn_;
    const bool redFirst_;
    const PictureFormat format_;
    bool entered_ = false;
    const void* mapped_ = nullptr;
    std::vector<std::byte> swapped_;
};

AsyncReadback::AsyncReadback(std::unique_ptr<gl::SharedReader> reader, const GlFunctions& gl)
    : reader_(std::move(reader)), gl_{gl.glGenBuffers,     gl.glBindBuffer,  gl.glBufferData,
                                      gl.glMapBufferRange, gl.glUnmapBuffer, gl.glFenceSync,
                                      gl.glClientWaitSync, gl.glDeleteSync,  gl.glFlush} {}

void AsyncReadback::bindBuffer(size_t bytes) {
    bound_ = {};
    {
        const std::lock_guard lock(mutex_);
        if (!free_.empty()) {
            bound_ = free_.back();
            free_.pop_back();
        }
    }
    if (bound_.name == 0) gl_.genBuffers(1, &bound_.name);
    gl_.bindBuffer(GL_PIXEL_PACK_BUFFER, bound_.name);
    if (bound_.bytes != bytes)
        gl_.bufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    bound_.bytes = bytes;
}

// The flush lets the other thread's wait end, even if no command follows.
std::unique_ptr<PictureRead> AsyncReadback::take(bool redFirst, PictureFormat format) {
    const Buffer buffer = std::exchange(bound_, {});
    const GLsync drawn = gl_.fenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl_.flush();
    if (drawn) return std::make_unique<PendingFrame>(shared_from_this(), buffer, drawn, redFirst, format);
    giveBack(buffer);
    return nullptr;
}

// The list of free buffers never exceeds the number of buffers in use at one time. The end of the share group frees
// them.
void AsyncReadback::giveBack(Buffer buffer) {
    const std::lock_guard lock(mutex_);
    free_.push_back(buffer);
}

} // namespace mural
