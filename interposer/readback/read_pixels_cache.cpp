#include "interposer/readback/read_pixels_cache.hpp"

#include <cstdlib>
#include <cstring>

#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/context/thread_state.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

constexpr GLsizei kSmall = 64; // maximum side in pixels for caching
constexpr GLint kBlock = 256;  // alignment of fetched blocks

const Window* windowRead(const Context& c) {
    GLint framebuffer = 0;
    gReal.glGetIntegerv(c.api == wire::Api::Desktop || c.version >= 30 ? GL_READ_FRAMEBUFFER_BINDING
                                                                       : GL_FRAMEBUFFER_BINDING,
                        &framebuffer);
    return framebuffer == 0 ? findWindowById(c.readWindow) : nullptr;
}

} // namespace

bool ReadPixelsCache::nothingSince(const ThreadState& t, const Kind& kind) const {
    // Draws of other threads do not appear in this thread's stream.
    return cursor_ && cursor_ == t.cursor && publications_ == t.publications && t.context &&
           context_ == t.context->id && !t.shared && kind_ == kind;
}

bool ReadPixelsCache::find(const ThreadState& t, const Kind& kind, const Box& box, void* into) const {
    const bool inside = box.x >= box_.x && box.y >= box_.y && int64_t{box.x} + box.w <= int64_t{box_.x} + box_.w &&
                        int64_t{box.y} + box.h <= int64_t{box_.y} + box_.h;
    if (!valid_ || !inside || !nothingSince(t, kind)) return false;
    const size_t rowBytes = size_t(box.w) * kind.groupBytes, stride = size_t(box_.w) * kind.groupBytes;
    const std::byte* from = bytes_ + size_t(box.y - box_.y) * stride + size_t(box.x - box_.x) * kind.groupBytes;
    for (GLsizei row = 0; row < box.h; ++row)
        std::memcpy(static_cast<std::byte*>(into) + size_t(row) * rowBytes, from + size_t(row) * stride, rowBytes);
    return true;
}

ReadPixelsCache::Box ReadPixelsCache::wider(const ThreadState& t, const Kind& kind, const Box& box) const {
    constexpr GLint kFar = 1 << 20;
    if (!nothingSince(t, kind) || box.w > kSmall || box.h > kSmall || box.x < 0 || box.y < 0 || box.x > kFar ||
        box.y > kFar)
        return box;
    const auto begin = [](GLint at) { return at / kBlock * kBlock; };
    const auto end = [](GLint at) { return (at + kBlock - 1) / kBlock * kBlock; };
    Box wide{begin(box.x), begin(box.y), 0, 0};
    GLint right = end(box.x + box.w), top = end(box.y + box.h);
    if (const Window* w = windowRead(*t.context)) {
        const auto width = static_cast<GLint>(w->config.width), height = static_cast<GLint>(w->config.height);
        if (box.x + box.w > width || box.y + box.h > height) return box;
        if (right > width) right = width;
        if (top > height) top = height;
    }
    wide.w = right - wide.x;
    wide.h = top - wide.y;
    return wide;
}

bool ReadPixelsCache::inSeries(const ThreadState& t, const Kind& kind, const Box& box) {
    constexpr uint32_t kMany = 16;
    series_ = nothingSince(t, kind) && box.w <= kSmall && box.h <= kSmall ? series_ + 1 : 0;
    return series_ >= kMany;
}

std::byte* ReadPixelsCache::memory(size_t sizeBytes) {
    valid_ = false;
    if (sizeBytes > capacityBytes_) {
        std::free(bytes_);
        bytes_ = static_cast<std::byte*>(std::malloc(sizeBytes));
        capacityBytes_ = bytes_ ? sizeBytes : 0;
    }
    return bytes_;
}

void ReadPixelsCache::answered(const ThreadState& t, const Kind& kind, const Box& box, bool stored) {
    cursor_ = t.context ? t.cursor : nullptr;
    publications_ = t.publications;
    context_ = t.context ? t.context->id : 0;
    kind_ = kind;
    box_ = box;
    valid_ = stored;
}

} // namespace mural
