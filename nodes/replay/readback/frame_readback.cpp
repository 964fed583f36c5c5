// Readback of a frame's picture: synchronous, or into a buffer for which the encoding thread waits.
//
// The buffer needs no wait for GL on this thread, which continues with the next frame's commands. It requires fences,
// pixel buffers, and a second context for the other thread. A measurement selects the method that costs the drawing
// thread less time (readback_choice.hpp). llvmpipe gains nothing from the buffer: it draws and copies within the read
// call, on this thread.
#include <cstring>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/replay/readback/async_readback.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

bool Replay::hasFences(const ContextState& c) const {
    return c.version >= (c.api == wire::Api::Desktop ? 32 : 30) && gl.glFenceSync && gl.glClientWaitSync &&
           gl.glDeleteSync;
}

// Creates the object for the first frame that wants it. A share group without support is not tried again.
std::shared_ptr<AsyncReadback> Replay::laterReads() {
    ShareGroup& shared = *bound_->shared;
    if (!std::exchange(shared.asyncTried, true)) {
        auto reader = platform_->createReader(bound_->contextConfig, *bound_->context);
        if (reader)
            shared.later = std::make_shared<AsyncReadback>(std::move(*reader), gl);
        else if (config_.readback == Readback::Buffer)
            log::warning(log::Topic::Replay, "asynchronous readback is off: " + reader.error().message);
    }
    return shared.later;
}

// Pictures that are assembled from other pixels than the shown ones are read synchronously.
bool Replay::readsLater(const Window& w, const PixelViewport& region, bool front) {
    if (config_.readback == Readback::Direct || skips_ || region.empty() || !bound_ || !bound_->shared) return false;
    if (config_.readback == Readback::Auto && !w.readback.later()) return false;
    if ((!passOf(w, front).zoom.none() && !w.plain) || (hasKernel() && w.plain)) return false;
    const bool buffers =
        gl.glGenBuffers && gl.glBindBuffer && gl.glBufferData && gl.glMapBufferRange && gl.glUnmapBuffer && gl.glFlush;
    return buffers && hasFences(*bound_) && isAnswering() && laterReads();
}

std::unique_ptr<PictureRead> Replay::readAtOnce(const PlayerOutputs::Frame& f, const PixelViewport& r) {
    const std::byte* const pixels = f.pixels(r);
    if (!pixels) return nullptr;
    const size_t bytes = static_cast<size_t>(r.area()) * 4;
    std::vector<std::byte> own;
    if (pixels == pixels_.data())
        own = std::exchange(pixels_, memory_->take());
    else
        own.assign(pixels, pixels + bytes);
    own.resize(bytes);
    return std::make_unique<ReadPicture>(std::move(own), memory_);
}

// Returns null if GL creates no fence.
std::unique_ptr<PictureRead> Replay::readLater(Window& w, const PixelViewport& r, bool front) {
    ContextState* const own = std::exchange(c_, bound_);
    const std::shared_ptr<AsyncReadback> reads = c_->shared->later;
    into_ = reads.get();
    (void)readShown(w, r, front);
    into_ = nullptr;
    auto picture = reads->take(c_->api != wire::Api::Desktop, pictureFormatOf(*c_, w));
    c_ = own;
    return picture;
}

} // namespace mural
