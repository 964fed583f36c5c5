// Reads pixels that this node has drawn, for the program and for the wall.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

#include "nodes/frame_transfer/bgra_swizzle.hpp"
#include "nodes/replay/readback/async_readback.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/sizes/pixel_format.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

// Returns false between glBegin and glEnd, and in a lost context: GL answers no queries, and a read leaves the memory
// unchanged.
bool Replay::isAnswering() {
    GLint alignment = 0;
    gl.glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
    return alignment != 0;
}

// Reads `r` of the program's read framebuffer, without the program's pack state and pack buffer.
const std::byte* Replay::readRegion(const PixelViewport& r, GLenum format, GLenum type, size_t bytes, Beyond beyond) {
    const size_t room = into_ ? 1 : std::max<size_t>(bytes, 1);
    if (beyond == Beyond::Black)
        pixels_.assign(room, std::byte{0});
    else
        pixels_.resize(room);
    if (r.empty() || !gl.glReadPixels) return pixels_.data();
    if (into_)
        into_->bindBuffer(bytes);
    else if (c_->packBuffer)
        gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    packTightly(true);
    const bool window = readsLean() && c_->readFramebuffer == 0;
    const PixelViewport o = window ? c_->read->region : PixelViewport{};
    const int32_t planted = config_.plant == "shift" && c_->readFramebuffer == 0 && r.x > 0 ? 1 : 0;
    // the memory still contains an earlier picture, of any program
    const bool fresh = beyond == Beyond::Nothing && !into_;
    const bool answering = !fresh || isAnswering();
    // Earlier errors must not count as errors of the read.
    if (fresh && takeErrors()) sendDriverEvent(wire::DriverEventKind::OutOfMemory, {0, c_->errorsReported, 0, 0, {}});
    gl.glReadPixels(r.x - o.x - planted, r.y - o.y, r.w, r.h, format, type, into_ ? nullptr : pixels_.data());
    if (fresh && (!answering || gl.glGetError() != GL_NO_ERROR)) std::ranges::fill(pixels_, std::byte{0});
    packTightly(false);
    if (into_ || c_->packBuffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, c_->packBuffer);
    return pixels_.data();
}

// Calls without pixel transfer (scale, bias, maps), which applies only to the program's own reads and draws.
void Replay::withPlainTransfer(const std::function<void()>& call) {
    const bool has = c_->api == wire::Api::Desktop && !c_->core && gl.glPixelTransferf && gl.glPushAttrib;
    if (!has) return call();
    gl.glPushAttrib(GL_PIXEL_MODE_BIT);
    for (const GLenum scale : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE, GL_DEPTH_SCALE})
        gl.glPixelTransferf(scale, 1);
    for (const GLenum bias : {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS, GL_DEPTH_BIAS, GL_INDEX_SHIFT,
                              GL_INDEX_OFFSET, GL_MAP_COLOR, GL_MAP_STENCIL})
        gl.glPixelTransferf(bias, 0);
    call();
    gl.glPopAttrib();
}

// Calls without the clamp of reads to 1. A copy of a half-float window needs all values, although drivers clamp its
// reads.
void Replay::withoutReadClamp(const std::function<void()>& call) {
    if (c_->api != wire::Api::Desktop || !gl.glClampColor) return call();
    GLint before = 0;
    gl.glGetIntegerv(GL_CLAMP_READ_COLOR, &before);
    gl.glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
    call();
    gl.glClampColor(GL_CLAMP_READ_COLOR, static_cast<GLenum>(before));
}

bool Replay::onRequestPixels(Args& in) {
    const auto request = in.get<uint32_t>();
    const auto x = in.get<int32_t>(), y = in.get<int32_t>(), w = in.get<int32_t>(), h = in.get<int32_t>();
    const auto format = in.get<uint32_t>(), type = in.get<uint32_t>(), groupAndFlags = in.get<uint32_t>();
    const uint32_t group = groupAndFlags & ~(wire::kPlainTransfer | wire::kResolved);
    if (!in.ok() || w < 0 || h < 0 || group == 0 || group > 64 ||
        uint64_t(w) * uint64_t(h) > config_.limits.answerBytes / group)
        return false;
    const ColourWords* const words = format == GL_RGBA ? colourWordsOf(type) : nullptr;
    if ((groupAndFlags & wire::kResolved) && !words) return false;
    const PixelViewport requested{x, y, w, h};
    if (!bound_ || group != sizes::groupBytes(format, type)) {
        answerBytes(request, wire::ReplyKind::Bytes, {});
        return true;
    }
    if (c_->readFramebuffer != 0) { // every node has all of it
        const size_t bytes = size_t(w) * size_t(h) * group;
        answerBytes(request, wire::ReplyKind::Bytes, {readRegion(requested, format, type, bytes), bytes});
        return true;
    }
    const bool deep = format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL || format == GL_STENCIL_INDEX;
    if (deep) depthForReading();
    const bool repeats = c_->read && interleaves(c_->read) && !c_->read->region.empty();
    const bool front = readsFront() && !deep;
    const auto owned = [&](const Window& from) {
        return repeats ? partOf(from, areasOf(from, front)) : regionOf(from, front);
    };
    const PixelViewport part = c_->read && config_.answers ? intersect(requested, owned(*c_->read)) : PixelViewport{};
    if (c_->read) c_->read->copied = true;
    if (hasSkipped_ && c_->read && !mayRead(*c_->read, deep)) out_.invalid();
    const size_t bytes = static_cast<size_t>(part.area()) * group;
    const std::byte* pixels = nullptr;
    // Erroneous copies request colours while no buffer is selected. In OpenGL ES, Mesa would read through a null
    // pointer.
    const bool nothing = !deep && c_->readBuffer0 == GL_NONE;
    const auto read = [&] {
        pixels = repeats && !nothing && !part.empty()
                     ? readRepeated(part, front, format, type, group)
                     : readRegion(nothing ? PixelViewport{} : part, format, type, bytes);
    };
    if ((groupAndFlags & wire::kResolved) && !nothing && !part.empty() && resolves(*c_->read))
        withQueriesSuspended([&] { pixels = readResolved(part, format, *words); });
    else if ((groupAndFlags & wire::kPlainTransfer) && type == GL_FLOAT)
        withPlainTransfer([&] { withoutReadClamp(read); });
    else if (groupAndFlags & wire::kPlainTransfer)
        withPlainTransfer(read);
    else
        read();
    wire::ReplyPartHeader header{};
    header.client = wire::clientOf(stream_);
    header.requestId = request;
    header.kind = static_cast<uint32_t>(wire::ReplyKind::Rectangle);
    header.groupBytes = group;
    header.x = part.x;
    header.y = part.y;
    header.w = part.w;
    header.h = part.h;
    header.first = !repeats && !part.empty() && part == requested; // no other node has pixels of it
    header.last = 1;
    out_.answer(header, {pixels, bytes});
    return true;
}

// Works around a defect of zink (Mesa 25.0). A read lacks the scissored clears since the last request of pixels or
// bytes, unless the driver is flushed in between, as by a swap. A flush also draws bitmaps that Mesa has batched. It is
// therefore omitted while the request must leave bitmaps in the batch (leavesBitmaps).
void Replay::flushIfRequested(Window& w) {
    if (bound_ && bound_->gathersBitmaps) return;
    if (std::exchange(w.requested, false) && gl.glFlush) gl.glFlush();
}

void Replay::answerBytes(uint32_t request, wire::ReplyKind kind, std::span<const std::byte> bytes) {
    wire::ReplyPartHeader header{};
    header.client = wire::clientOf(stream_);
    header.requestId = request;
    header.kind = static_cast<uint32_t>(kind);
    header.first = 1;
    header.last = 1;
    out_.answer(header, bytes);
}

// Reads into pixels_. glGetn… and glGetTextureImage stay within the given size, whatever size the level has.
void Replay::readTexels(bool byName, GLuint which, GLint level, GLenum format, GLenum type) {
    const auto room = static_cast<GLsizei>(std::min<size_t>(pixels_.size(), INT32_MAX));
    if (byName && gl.glGetTextureImage)
        gl.glGetTextureImage(which, level, format, type, room, pixels_.data());
    else if (!byName && gl.glGetnTexImageARB)
        gl.glGetnTexImageARB(which, level, format, type, room, pixels_.data());
    else if (!byName && gl.glGetnTexImage)
        gl.glGetnTexImage(which, level, format, type, room, pixels_.data());
}

// The same for a compressed image, without conversion. Mesa's glGetnCompressedTexImageARB ignores the given size.
void Replay::readBlocks(bool byName, GLuint which, GLint level) {
    const auto room = static_cast<GLsizei>(std::min<size_t>(pixels_.size(), INT32_MAX));
    constexpr GLenum kBlockNames[] = {GL_PACK_COMPRESSED_BLOCK_WIDTH, GL_PACK_COMPRESSED_BLOCK_HEIGHT,
                                      GL_PACK_COMPRESSED_BLOCK_DEPTH, GL_PACK_COMPRESSED_BLOCK_SIZE};
    GLint blocks[4] = {}, needed = 0;
    for (size_t i = 0; c_->packsBlocks && i < 4; ++i) {
        gl.glGetIntegerv(kBlockNames[i], &blocks[i]);
        gl.glPixelStorei(kBlockNames[i], 0);
    }
    if (!byName && gl.glGetTexLevelParameteriv)
        gl.glGetTexLevelParameteriv(which, level, GL_TEXTURE_COMPRESSED_IMAGE_SIZE, &needed);
    if (byName && gl.glGetCompressedTextureImage)
        gl.glGetCompressedTextureImage(which, level, room, pixels_.data());
    else if (needed > 0 && needed <= room && gl.glGetCompressedTexImage)
        gl.glGetCompressedTexImage(which, level, pixels_.data());
    for (size_t i = 0; c_->packsBlocks && i < 4; ++i) gl.glPixelStorei(kBlockNames[i], blocks[i]);
}

bool Replay::onRequestTexImage(Args& in) {
    const auto request = in.get<uint32_t>(), byName = in.get<uint32_t>(), which = in.get<uint32_t>();
    const auto level = in.get<int32_t>();
    const auto format = in.get<uint32_t>(), type = in.get<uint32_t>();
    const auto bytes = in.get<uint64_t>();
    if (!in.ok() || bytes > config_.limits.answerBytes) return false;
    pixels_.assign(static_cast<size_t>(bytes), std::byte{0});
    if (bound_ && bytes > 0) {
        if (c_->packBuffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        packTightly(true);
        const GLuint image = byName ? name(Kind::Texture, which) : which;
        if (format == 0)
            readBlocks(byName != 0, image, level);
        else
            readTexels(byName != 0, image, level, format, type);
        packTightly(false);
        if (c_->packBuffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, c_->packBuffer);
    }
    answerBytes(request, wire::ReplyKind::Bytes, pixels_);
    return true;
}

// Returns results of transform feedback or shaders, which are equal on every node that runs all vertices.
bool Replay::onRequestBuffer(Args& in) {
    const auto request = in.get<uint32_t>(), buffer = in.get<uint32_t>();
    const auto offset = in.get<uint64_t>(), bytes = in.get<uint64_t>();
    if (!in.ok() || bytes > config_.limits.answerBytes || offset > uint64_t{INT64_MAX} - bytes) return false;
    pixels_.assign(static_cast<size_t>(bytes), std::byte{0});
    if (bound_ && bytes > 0 && gl.glMapBufferRange && gl.glUnmapBuffer) readBuffer(name(Kind::Buffer, buffer), offset);
    answerBytes(request, wire::ReplyKind::Bytes, pixels_);
    return true;
}

// Reads into pixels_. Copies storage first that cannot be mapped for reading (immutable, of ES).
void Replay::readBuffer(GLuint nodeName, uint64_t offset) {
    const auto bytes = static_cast<GLsizeiptr>(pixels_.size());
    const bool desktop = c_->api == wire::Api::Desktop && gl.glGetBufferSubData;
    GLint before = 0;
    gl.glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &before);
    gl.glBindBuffer(GL_COPY_READ_BUFFER, nodeName);
    if (gl.glMemoryBarrier) gl.glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (desktop) {
        gl.glGetBufferSubData(GL_COPY_READ_BUFFER, static_cast<GLintptr>(offset), bytes, pixels_.data());
    } else {
        GLint writeBefore = 0;
        GLuint copy = 0;
        gl.glGetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &writeBefore);
        gl.glGenBuffers(1, &copy);
        gl.glBindBuffer(GL_COPY_WRITE_BUFFER, copy);
        gl.glBufferData(GL_COPY_WRITE_BUFFER, bytes, nullptr, GL_STREAM_READ);
        gl.glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset), 0, bytes);
        if (const void* from = gl.glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, bytes, GL_MAP_READ_BIT)) {
            std::memcpy(pixels_.data(), from, pixels_.size());
            gl.glUnmapBuffer(GL_COPY_WRITE_BUFFER);
        }
        gl.glBindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(writeBefore));
        gl.glDeleteBuffers(1, &copy);
    }
    gl.glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(before));
}

// Returns Bgra8 for OpenGL ES before 3, which reads windows as bytes only.
PictureFormat Replay::pictureFormatOf(const ContextState& reader, const Window& w) const {
    const bool reads = reader.api == wire::Api::Desktop || reader.version >= 30;
    return config_.deepPictures && reads && w.config.red == 10 ? PictureFormat::Bgr10A2 : PictureFormat::Bgra8;
}

// Reads the window's picture, regardless of the program's bindings. Called at a swap.
const std::byte* Replay::readShown(Window& w, const PixelViewport& r, bool front) {
    const GLuint bound = c_->readFramebuffer;
    const bool separate = c_->version >= 30;
    const GLenum target = separate ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    const GLuint draw = c_->drawFramebuffer;
    if (bound && gl.glBindFramebuffer) gl.glBindFramebuffer(target, 0);
    gl::Surface* const shown = surfaceOf(&w, w.config.doubleBuffer && !front ? GL_BACK : GL_FRONT);
    const bool otherRead = readSurface_ != shown;
    if (otherRead) (void)platform_->makeCurrent(c_->context.get(), shown, shown);
    const bool chooses = (c_->api == wire::Api::Desktop || separate) && gl.glReadBuffer;
    if (chooses) gl.glReadBuffer(windowBuffer(w.config.doubleBuffer && !front ? GL_BACK : GL_FRONT, &w));
    c_->readFramebuffer = 0;
    Window* read = c_->read;
    c_->read = &w;
    const size_t bytes = static_cast<size_t>(r.area()) * 4;
    const bool bgra = c_->api == wire::Api::Desktop;
    const std::byte* pixels = nullptr;
    const GLenum format = bgra ? GL_BGRA : GL_RGBA;
    const PictureFormat shownFormat = pictureFormatOf(*c_, w);
    const ColourWords& words = shownFormat == PictureFormat::Bgr10A2 ? kTenBitWords : kByteWords;
    if (resolves(w) && !r.empty())
        withQueriesSuspended([&] { pixels = readResolved(r, format, words); });
    else
        withPlainTransfer([&] { pixels = readRegion(r, format, words.type, bytes, Beyond::Nothing); });
    if (!bgra && !into_) swapRedAndBlue(shownFormat, pixels_.data(), pixels_.data(), bytes / 4);
    c_->read = read;
    c_->readFramebuffer = bound;
    if (chooses) gl.glReadBuffer(windowBuffer(c_->readBuffer0, &w));
    if (otherRead) (void)platform_->makeCurrent(c_->context.get(), drawSurface_, readSurface_);
    if (bound && gl.glBindFramebuffer) gl.glBindFramebuffer(target, name(Kind::Framebuffer, separate ? bound : draw));
    return pixels;
}

bool Replay::resolves(const Window& w) const {
    return w.config.samples > 0 && c_->version >= 30 && gl.glBlitFramebuffer && gl.glRenderbufferStorage;
}

// A swap shows the resolved picture, but glReadPixels of a multisampled window returns one sample (Mesa). The window is
// bound for reading before and after the call.
const std::byte* Replay::readResolved(const PixelViewport& r, GLenum format, const ColourWords& words) {
    GLint renderbuffer = 0;
    gl.glGetIntegerv(GL_RENDERBUFFER_BINDING, &renderbuffer);
    GLuint buffer = 0, framebuffer = 0;
    gl.glGenRenderbuffers(1, &buffer);
    gl.glGenFramebuffers(1, &framebuffer);
    gl.glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl.glRenderbufferStorage(GL_RENDERBUFFER, words.storage, r.w, r.h);
    gl.glBindRenderbuffer(GL_RENDERBUFFER, static_cast<GLuint>(renderbuffer));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    gl.glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    gl.glDisable(GL_SCISSOR_TEST);
    const bool srgb = c_->api == wire::Api::Desktop && gl.glIsEnabled(GL_FRAMEBUFFER_SRGB);
    if (srgb) gl.glDisable(GL_FRAMEBUFFER_SRGB);
    const PixelViewport o = readsLean() ? c_->read->region : PixelViewport{};
    gl.glBlitFramebuffer(r.x - o.x, r.y - o.y, r.right() - o.x, r.top() - o.y, 0, 0, r.w, r.h, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
    if (srgb) gl.glEnable(GL_FRAMEBUFFER_SRGB);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    const std::byte* pixels = nullptr;
    Window* const window = std::exchange(c_->read, nullptr); // the pixels now begin at 0, 0
    const size_t bytes = static_cast<size_t>(r.area()) * words.sizeBytes;
    withPlainTransfer([&] { pixels = readRegion({0, 0, r.w, r.h}, format, words.type, bytes, Beyond::Nothing); });
    c_->read = window;
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(Kind::Framebuffer, c_->drawFramebuffer));
    gl.glDeleteFramebuffers(1, &framebuffer);
    gl.glDeleteRenderbuffers(1, &buffer);
    c_->scissorsDiffer = c_->scissorsDiffer || gl.glScissorIndexed; // the enables of all viewports have changed
    applyScissors();
    return pixels;
}

// Stores pixels of other tiles for a following copy. Uses a blit from a texture, which ignores all other state.
bool Replay::onFillWindow(Args& in) {
    const auto x = in.get<int32_t>(), y = in.get<int32_t>(), w = in.get<int32_t>(), h = in.get<int32_t>();
    const auto planeAndFlag = in.get<uint32_t>(),
               plane = planeAndFlag & ~(wire::kForCopy | wire::kTenBits | wire::kFloats);
    const ColourWords& words = planeAndFlag & wire::kFloats    ? kFloatWords
                               : planeAndFlag & wire::kTenBits ? kTenBitWords
                                                               : kByteWords;
    const Data data = in.data();
    const uint64_t bytesPer = plane == GL_STENCIL_BUFFER_BIT ? 1 : plane == GL_COLOR_BUFFER_BIT ? words.sizeBytes : 4;
    if (!in.ok() || w <= 0 || h <= 0 || data.absent() || data.isOffset() ||
        data.size() / bytesPer / uint64_t(w) < uint64_t(h) || x > INT32_MAX - w || y > INT32_MAX - h)
        return false;
    if (plane == GL_COLOR_BUFFER_BIT && c_->readBuffer0 == GL_NONE) return true; // the copy is an error
    if (c_->read) c_->read->filled = true;
    // these pixels belong to another pass, and this node has all pixels of its own pass
    if (bound_ && c_->read && !config_.answers && !readsLean() &&
        (c_->read->region == c_->read->whole || c_->read->drawn == c_->read->whole)) {
        forgetGathered();
        return true;
    }
    if (bound_ && (readsLean() || ((planeAndFlag & wire::kForCopy) && c_->read && resolves(*c_->read)))) {
        gatherForCopy({x, y, w, h}, plane, data.pointer(), words);
        return true;
    }
    if (!bound_ || !c_->read || !gl.glBlitFramebuffer) return true;
    c_->read->copied = true;
    if (interleaves(c_->read)) return true; // a window with a kernel has no room for them
    forgetGathered();                       // from another window
    withQueriesSuspended([&] {
        if (plane != GL_COLOR_BUFFER_BIT)
            fillByOtherContext({x, y, w, h}, plane, data.pointer());
        else
            fillColor({x, y, w, h}, data.pointer(), words);
    });
    return true;
}

namespace {
// Returns the parts of `r` around the hole.
std::array<PixelViewport, 4> around(const PixelViewport& r, const PixelViewport& hole) {
    if (hole.empty()) return {r};
    const auto box = [&](int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
        return intersect(r, {x0, y0, x1 - x0, y1 - y0});
    };
    return {box(r.x, r.y, hole.x, r.top()), box(hole.right(), r.y, r.right(), r.top()),
            box(hole.x, r.y, hole.right(), hole.y), box(hole.x, hole.top(), hole.right(), r.top())};
}
} // namespace

// Writes colours into the read window, regardless of the program's state. The node's own part of a multisampled window
// keeps its samples.
void Replay::fillColor(const PixelViewport& r, const void* rgba, const ColourWords& words) {
    if (c_->api == wire::Api::Es1) return fillByOtherContext(r, GL_COLOR_BUFFER_BIT, rgba, words.type);
    // The read window is the draw window during the blit.
    const bool otherDraw = drawSurface_ != readSurface_;
    if (otherDraw) (void)platform_->makeCurrent(c_->context.get(), readSurface_, readSurface_);
    GLint texture2d = 0, unit = 0;
    gl.glGetIntegerv(GL_ACTIVE_TEXTURE, &unit);
    gl.glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture2d);
    GLuint texture = 0;
    gl.glGenTextures(1, &texture);
    gl.glBindTexture(GL_TEXTURE_2D, texture);
    if (c_->unpackBuffer) gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    setUnpack(true);
    withPlainTransfer([&] {
        gl.glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(words.storage), r.w, r.h, 0, GL_RGBA, words.type, rgba);
    });
    if (c_->unpackBuffer) gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, c_->unpackBuffer);
    gl.glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture2d));
    if (!c_->fillFramebuffer) gl.glGenFramebuffers(1, &c_->fillFramebuffer);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, c_->fillFramebuffer);
    gl.glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    const bool chooses = c_->api == wire::Api::Desktop && gl.glDrawBuffer;
    if (chooses) gl.glDrawBuffer(windowBuffer(c_->readBuffer0, c_->read));
    gl.glDisable(GL_SCISSOR_TEST);
    const GLboolean srgb = c_->api == wire::Api::Desktop && gl.glIsEnabled(GL_FRAMEBUFFER_SRGB);
    if (srgb) gl.glDisable(GL_FRAMEBUFFER_SRGB);
    const PixelViewport o = readsLean() ? c_->read->region : PixelViewport{};
    for (const PixelViewport& part :
         around(r, c_->read->config.samples > 0
                       ? intersect(r, moves() && readsFront() ? regionOf(*c_->read, true) : c_->read->drawn)
                       : PixelViewport{})) {
        const int32_t x = part.x - r.x, y = part.y - r.y, toX = part.x - o.x, toY = part.y - o.y;
        if (!part.empty())
            gl.glBlitFramebuffer(x, y, x + part.w, y + part.h, toX, toY, toX + part.w, toY + part.h,
                                 GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    if (srgb) gl.glEnable(GL_FRAMEBUFFER_SRGB);
    if (chooses) gl.glDrawBuffer(windowBuffer(c_->drawBuffer0, c_->read));
    gl.glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    gl.glDeleteTextures(1, &texture);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, name(Kind::Framebuffer, c_->readFramebuffer));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(Kind::Framebuffer, c_->drawFramebuffer));
    if (otherDraw) (void)platform_->makeCurrent(c_->context.get(), drawSurface_, readSurface_);
    c_->scissorsDiffer = true; // the enables of all viewports have changed
    applyScissors();
}

} // namespace mural
