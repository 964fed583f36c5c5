// Replays control records: contexts, windows, client memory. context/swaps.cpp handles the records for frames.
#include <cstring>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/gl/config_match.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/window_use.hpp"
#include "streamcodec/wire/context_flags.hpp"
#include "streamcodec/sizes/vertex_types.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

namespace {
// More than any record needs (72 spans of client arrays). Without this limit empty blobs could grow the queue.
constexpr size_t kMaxBlobs = 256;
} // namespace

gl::SurfaceConfig Replay::surfaceConfig(const wire::WindowConfig& c, int width, int height) const {
    gl::SurfaceConfig s;
    s.width = width;
    s.height = height;
    s.red = c.red;
    s.green = c.green;
    s.blue = c.blue;
    s.alpha = c.alpha;
    s.depth = c.depth;
    s.stencil = c.stencil;
    s.samples = c.samples;
    s.accum = platform_->accumulates() ? c.accum : 0; // without native ones the replay has its own accumulation buffer
    s.srgb = c.srgb != 0;
    s.stereo = false; // a node has the buffers of one eye (bufferOfEye)
    return s;
}

bool Replay::own(uint16_t opcode, Args& in) {
    sendDriverMessages(); // before a reply that the program waits for
    if (!leavesBitmaps(opcode)) settleBitmaps();
    if (opcode == wire::kOpRequestPixels || opcode == wire::kOpRequestTexImage || opcode == wire::kOpRequestBuffer ||
        opcode == wire::kOpFillWindow) {
        for (Window* const w : {c_->draw, c_->read}) {
            if (!w) continue;
            flushIfRequested(*w);
            w->requested = true;
        }
    }
    switch (opcode) {
    case wire::kOpBlobBegin: return onBlobBegin(in);
    case wire::kOpBlobData: {
        const auto bytes = in.get<uint32_t>();
        const auto* p = in.fixed<std::byte>(bytes);
        if (!in.ok() || s_->blobs.empty() || bytes > s_->blobMissing) return false;
        s_->blobs.back().insert(s_->blobs.back().end(), p, p + bytes);
        s_->blobMissing -= bytes;
        return true;
    }
    case wire::kOpCreateContext: return onCreateContext(in);
    case wire::kOpDestroyContext: return onDestroyContext(in);
    case wire::kOpMakeCurrent: return onMakeCurrent(in);
    case wire::kOpWindow: return onWindow(in);
    case wire::kOpDestroyWindow: return onDestroyWindow(in);
    case wire::kOpSwap: return onSwap(in, false);
    case wire::kOpFrontPicture: return onSwap(in, true);
    case wire::kOpClientArrays: return onClientArrays(in);
    case wire::kOpRequestPixels: return onRequestPixels(in);
    case wire::kOpRequestTexImage: return onRequestTexImage(in);
    case wire::kOpRequestQuery: return onRequestQuery(in);
    case wire::kOpBeginConditional: return onBeginConditional(in);
    case wire::kOpQueryKnown: return onQueryKnown(in);
    case wire::kOpDrawAll: return onDrawAll(in);
    case wire::kOpErrorReported: return errorReported();
    case wire::kOpRequestProgram: return onRequestProgram(in);
    case wire::kOpProgramRecipe: return onProgramRecipe(in);
    case wire::kOpRequestBuffer: return onRequestBuffer(in);
    case wire::kOpFillWindow: return onFillWindow(in);
    case wire::kOpProgramLayout: return onProgramLayout(in);
    case wire::kOpBufferBytes: return onBufferBytes(in);
    case wire::kOpCreateImage: return onCreateImage(in);
    case wire::kOpDestroyImage: return onDestroyImage(in);
    case wire::kOpFinish: {
        const auto request = in.get<uint32_t>();
        if (!in.ok()) return false;
        if (gl.glFinish && bound_) gl.glFinish();
        const uint64_t zero = 0;
        answerBytes(request, wire::ReplyKind::Sum, std::as_bytes(std::span(&zero, 1)));
        return true;
    }
    default: return false;
    }
}

bool Replay::onBlobBegin(Args& in) {
    const auto bytes = in.get<uint64_t>();
    if (!in.ok() || s_->blobMissing || s_->blobs.size() >= kMaxBlobs || s_->blobBytes > config_.limits.blobBytes ||
        bytes > config_.limits.blobBytes - s_->blobBytes)
        return false;
    s_->blobs.emplace_back(); // grows with the bytes that actually arrive
    s_->blobMissing = bytes;
    s_->blobBytes += bytes;
    return true;
}

bool Replay::onCreateContext(Args& in) {
    const auto id = in.get<uint32_t>(), share = in.get<uint32_t>(), api = in.get<uint32_t>();
    const auto major = in.get<uint32_t>(), minor = in.get<uint32_t>(), profile = in.get<uint32_t>(),
               flags = in.get<uint32_t>();
    const auto* config = in.fixed<wire::WindowConfig>(sizeof(wire::WindowConfig));
    if (!in.ok() || api > 2) return false;
    Client& client = clients_[wire::clientOf(stream_)];
    // Streams point to contexts, so an existing one is never replaced.
    if (id == 0 || client.contexts.count(id)) return false;
    const auto sharer = client.contexts.find(share);
    ContextState* with = sharer == client.contexts.end() ? nullptr : sharer->second.get();
    auto c = std::make_unique<ContextState>();
    gl::ContextConfig contextConfig;
    contextConfig.api = static_cast<gl::Api>(api);
    contextConfig.major = static_cast<int>(major);
    contextConfig.minor = static_cast<int>(minor);
    contextConfig.core = profile & GL_CONTEXT_CORE_PROFILE_BIT;
    contextConfig.forwardCompatible = flags & GL_CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT;
    contextConfig.debug = flags & GL_CONTEXT_FLAG_DEBUG_BIT;
    c->pendingCommands = flags & wire::kKeepsUnflushed;
    contextConfig.robust = flags & GL_CONTEXT_FLAG_ROBUST_ACCESS_BIT;
    contextConfig.reportsReset = true; // the node needs the notification, even if the program does not request it
    contextConfig.surface = surfaceConfig(*config, 1, 1);
    auto made = platform_->createContext(contextConfig, with ? with->context.get() : nullptr);
    if (!made) {
        log::warning(log::Topic::Replay, "cannot create a context like the program's: " + made.error().message);
        return true;
    }
    c->client = wire::clientOf(stream_);
    c->id = id;
    c->context = std::move(*made);
    c->contextConfig = contextConfig;
    c->shared = with ? with->shared : std::make_shared<ShareGroup>();
    c->api = static_cast<wire::Api>(api);
    c->version = static_cast<int>(major * 10 + minor);
    c->core = contextConfig.core;
    c->debugs = contextConfig.debug;
    c->unpack.values[5] = c->pack[5] = 4; // alignment
    c->drawBuffer0 = c->readBuffer0 = config->doubleBuffer || c->api != wire::Api::Desktop ? GL_BACK : GL_FRONT;
    client.contexts[id] = std::move(c);
    log::debug(log::Topic::Replay, "client ", wire::clientOf(stream_), ": context ", id, ", api ", api, ", version ",
               major, ".", minor, share != 0 ? ", shares with " : "", share != 0 ? std::to_string(share) : "");
    return true;
}

bool Replay::onMakeCurrent(Args& in) {
    const auto context = in.get<uint32_t>(), draw = in.get<uint32_t>(), read = in.get<uint32_t>();
    if (!in.ok()) return false;
    Client& client = clients_[wire::clientOf(stream_)];
    const auto windowOf = [&](uint32_t id) -> Window* {
        const auto it = client.windows.find(id);
        return it == client.windows.end() ? nullptr : it->second.get();
    };
    const auto it = client.contexts.find(context);
    // Flushes the context that the thread releases, unless the program has disabled that (KHR_context_flush_control).
    if (s_->context && s_->context == bound_ && !s_->context->pendingCommands && gl.glFlush) gl.glFlush();
    s_->context = it == client.contexts.end() ? nullptr : it->second.get();
    s_->draw = windowOf(draw);
    s_->read = windowOf(read);
    const bool first = s_->context && !s_->context->everCurrent;
    const bool bound = bindStream(*s_);
    freeDestroyed(client);
    if (!bound || !first || c_ != s_->context) return c_ != nullptr;
    // The first binding sets viewport and scissor to the window's size (GL 4.6 §13.6.1).
    c_->everCurrent = true;
    if (config_.plant == "names") offsetObjectNames();
    if (c_->debugs) listenToDriver();
    const PixelViewport whole = s_->draw ? s_->draw->whole : PixelViewport{};
    for (auto& s : c_->scissors) s = {false, whole};
    for (auto& v : c_->viewports) v = {0, 0, static_cast<GLfloat>(whole.w), static_cast<GLfloat>(whole.h)};
    restoreWindowState();
    return true;
}

bool Replay::onWindow(Args& in) {
    const auto id = in.get<uint32_t>();
    const auto* config = in.fixed<wire::WindowConfig>(sizeof(wire::WindowConfig));
    if (!in.ok() || config->width > 1 << 20 || config->height > 1 << 20) return false;
    auto& slot = clients_[wire::clientOf(stream_)].windows[id];
    if (!slot) {
        slot = std::make_unique<Window>();
        slot->lean = config_.lean;
        slot->skipped = skips_;
        if (skips_) slot->stale = kWindowBuffers | GL_ACCUM_BUFFER_BIT;
        slot->range.returns = returnsSeen();
    }
    Window& w = *slot;
    w.destroyed = false; // the program has bound it again
    // An equal size means that the program's driver has destroyed the drawable and created it again.
    const bool renewed = w.surface && config->width == w.config.width && config->height == w.config.height;
    if (config->stereo && !w.config.stereo && config_.pass.eye == Eye::Cyclop && config_.answers && config_.node == 0)
        log::warning(log::Topic::Replay,
                     "the program draws into a buffer for each eye, but only the left one is shown; --stereo quad, "
                     "side-by-side or anaglyph shows both");
    w.config = *config;
    w.isFlat = config->depth == 0 && config->stencil == 0;
    w.programRed = config->red;
    const auto width = static_cast<int32_t>(config->width), height = static_cast<int32_t>(config->height);
    w.whole = {0, 0, width, height};
    if (moves()) {
        const PixelViewport whole = surfaceOf(w, false);
        if (!w.surface || renewed || w.surface->width() != whole.w || w.surface->height() != whole.h) redivide(w);
    }
    w.part = partOf(w, w.moving.areas.get());
    placePart(w);
    const PixelViewport size = surfaceOf(w, w.lean);
    if (w.surface && !renewed && w.surface->width() == size.w && w.surface->height() == size.h) {
        takeBitsOfSurface(w);
        return true;
    }
    auto made = platform_->createSurface(surfaceConfig(*config, size.w, size.h));
    if (!made) {
        log::warning(log::Topic::Replay,
                     "cannot create a framebuffer like the program's window (" + std::to_string(width) + "x" +
                         std::to_string(height) + "): " + made.error().message +
                         (config_.pass.zoom.x > 1 || config_.pass.zoom.y > 1 ? "; or reduce the compound's zoom" : ""));
        return true;
    }
    log::debug(log::Topic::Replay, "window ", id, " of ", width, "x", height, " pixels, framebuffer of ", size.w, "x",
               size.h);
    alphaHides_ = alphaHides_ || (*made)->hiddenAlpha();
    const bool bound = &w == boundDraw_ || &w == boundRead_;
    std::unique_ptr<gl::Surface> old = std::move(w.surface);
    std::unique_ptr<gl::Surface> oldFront = std::move(w.front);
    dropFront(w);
    w.surface = std::move(*made);
    takeBitsOfSurface(w);
    w.readback = {};
    w.accumulated.clear();
    if (bound) {
        boundDraw_ = boundRead_ = nullptr;
        bound_ = nullptr;
        (void)bindStream(*s_);
        // Another stream's context had the old surface. It binds the new one with its next packet.
        if (!bound_) (void)platform_->makeCurrent(nullptr, nullptr, nullptr);
    }
    return true;
}

// Sets the window's configuration to the bits of the created surface. Further surfaces of the window, and copies
// between them, use the same bits.
void Replay::takeBitsOfSurface(Window& w) {
    const gl::SurfaceConfig& there = w.surface->config();
    const std::string differs = gl::describeDifference(there, surfaceConfig(w.config, there.width, there.height));
    if (differs.empty()) return;
    w.config.red = static_cast<uint8_t>(there.red);
    w.config.green = static_cast<uint8_t>(there.green);
    w.config.blue = static_cast<uint8_t>(there.blue);
    w.config.alpha = static_cast<uint8_t>(there.alpha);
    w.config.depth = static_cast<uint8_t>(there.depth);
    w.config.stencil = static_cast<uint8_t>(there.stencil);
    w.config.samples = static_cast<uint8_t>(there.samples);
    if (differs == std::exchange(reportedBits_, differs)) return;
    log::warning(log::Topic::Replay, "its GL has no framebuffer like the program's window and draws it with " +
                                         differs + "; pixels may differ from the native picture");
}

bool Replay::onClientArrays(Args& in) {
    using client_arrays::ArrayRecord;
    const auto arrayCount = in.get<uint32_t>(), spanCount = in.get<uint32_t>();
    if (!in.ok() || arrayCount > client_arrays::kSlots || spanCount > arrayCount) return false;
    const auto* arrays = in.fixed<ArrayRecord>(arrayCount * sizeof(ArrayRecord));
    if (!in.ok()) return false;
    if (c_->arrayMemory.size() < spanCount) c_->arrayMemory.resize(spanCount);
    for (uint32_t i = 0; i < spanCount; ++i) {
        const Data d = in.data();
        if (!in.ok()) return false;
        // The draw may follow in another packet, so its arrays must outlive this one.
        c_->arrayMemory[i].assign(d.span().begin(), d.span().end());
    }
    for (uint32_t i = 0; i < arrayCount; ++i) {
        const ArrayRecord& a = arrays[i];
        const uint32_t element = sizes::attributeBytes(a.size, a.type);
        if (a.slot >= client_arrays::kSlots || a.span >= spanCount || a.elementCount == 0) return false;
        const uint64_t end = uint64_t{a.offsetBytes} + uint64_t{a.elementCount - 1} * a.strideBytes + element;
        if (end > c_->arrayMemory[a.span].size()) return false;
    }
    if (c_ == none_.get()) return true;
    if (c_->arrayBuffer && gl.glBindBuffer) gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
    for (uint32_t i = 0; i < arrayCount; ++i) {
        const ArrayRecord& a = arrays[i];
        const auto first = reinterpret_cast<uintptr_t>(c_->arrayMemory[a.span].data()) + a.offsetBytes;
        setArrayPointer(a, reinterpret_cast<const std::byte*>(
                               first - static_cast<uintptr_t>(intptr_t{a.firstElement} * a.strideBytes)));
    }
    if (c_->arrayBuffer && gl.glBindBuffer) gl.glBindBuffer(GL_ARRAY_BUFFER, c_->arrayBuffer);
    return true;
}

void Replay::setArrayPointer(const client_arrays::ArrayRecord& a, const std::byte* first) {
    using namespace client_arrays;
    const auto stride = static_cast<GLsizei>(a.strideBytes);
    switch (a.slot) {
    case kVertex: return gl.glVertexPointer(a.size, a.type, stride, first);
    case kNormal: return gl.glNormalPointer(a.type, stride, first);
    case kColor: return gl.glColorPointer(a.size, a.type, stride, first);
    case kSecondaryColor: return gl.glSecondaryColorPointer(a.size, a.type, stride, first);
    case kFogCoord: return gl.glFogCoordPointer(a.type, stride, first);
    case kIndex: return gl.glIndexPointer(a.type, stride, first);
    case kEdgeFlag: return gl.glEdgeFlagPointer(stride, first);
    case kPointSize: return gl.glPointSizePointerOES ? gl.glPointSizePointerOES(a.type, stride, first) : void();
    default: break;
    }
    if (a.slot < kGeneric0) {
        GLint unit = 0;
        if (gl.glClientActiveTexture) {
            gl.glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &unit);
            gl.glClientActiveTexture(GL_TEXTURE0 + a.slot - kTexCoord0);
        }
        gl.glTexCoordPointer(a.size, a.type, stride, first);
        if (gl.glClientActiveTexture) gl.glClientActiveTexture(static_cast<GLenum>(unit));
        return;
    }
    const GLuint index = a.slot - kGeneric0;
    if (a.flags & kInteger)
        gl.glVertexAttribIPointer(index, a.size, a.type, stride, first);
    else if (a.flags & kLong)
        gl.glVertexAttribLPointer(index, a.size, a.type, stride, first);
    else
        gl.glVertexAttribPointer(index, a.size, a.type, a.flags & kNormalized, stride, first);
}

bool Replay::onProgramLayout(Args& in) {
    const auto program = in.get<uint32_t>();
    const Data layout = in.data();
    const auto bytes = layout.span();
    if (!in.ok() || bytes.size() < 4) return false;
    if (c_ == none_.get()) return true;
    uint32_t count = 0;
    std::memcpy(&count, bytes.data(), 4);
    replay::ProgramInfo info;
    const GLuint nodeName = name(Kind::Program, program);
    size_t at = 4;
    for (uint32_t i = 0; i < count; ++i) {
        GLint location = 0;
        uint32_t length = 0;
        if (bytes.size() - at < 8) return false;
        std::memcpy(&location, bytes.data() + at, 4);
        std::memcpy(&length, bytes.data() + at + 4, 4);
        at += 8;
        if (length > bytes.size() - at) return false;
        const std::string text(reinterpret_cast<const char*>(bytes.data()) + at, length);
        at = std::min(at + (size_t{length} + 3) / 4 * 4, bytes.size());
        const GLint here = gl.glGetUniformLocation(nodeName, text.c_str());
        if (here != location) info.locations[location] = here;
    }
    if (info.locations.empty())
        c_->shared->programs.erase(program);
    else
        c_->shared->programs[program] = std::move(info);
    return true;
}

bool Replay::onBufferBytes(Args& in) {
    const auto buffer = in.get<uint32_t>();
    const auto offset = in.get<uint64_t>();
    const Data bytes = in.data();
    if (!in.ok()) return false;
    if (c_ == none_.get() || bytes.size() == 0) return true;
    const GLuint nodeName = name(Kind::Buffer, buffer);
    // Uses a target that no draw reads, so that the program's bindings do not change.
    const bool copyTarget = c_->version >= 31 || (c_->api != wire::Api::Desktop && c_->version >= 30);
    const GLenum target = copyTarget ? GL_COPY_WRITE_BUFFER : GL_ARRAY_BUFFER;
    GLint before = 0;
    gl.glGetIntegerv(copyTarget ? GL_COPY_WRITE_BUFFER_BINDING : GL_ARRAY_BUFFER_BINDING, &before);
    gl.glBindBuffer(target, nodeName);
    if (copyTarget && onlyCopiesWrite(target))
        copyIntoBuffer(target, offset, bytes.span());
    else
        gl.glBufferSubData(target, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
                           bytes.pointer());
    gl.glBindBuffer(target, static_cast<GLuint>(before));
    return true;
}

// Detects immutable storage that the program may not write. GL itself may still write there, for example query results.
bool Replay::onlyCopiesWrite(GLenum target) {
    if (!gl.glBufferStorage || !gl.glGetBufferParameteriv || !gl.glCopyBufferSubData || c_->api != wire::Api::Desktop ||
        c_->version < 44)
        return false;
    GLint immutable = 0, flags = 0;
    gl.glGetBufferParameteriv(target, GL_BUFFER_IMMUTABLE_STORAGE, &immutable);
    if (immutable) gl.glGetBufferParameteriv(target, GL_BUFFER_STORAGE_FLAGS, &flags);
    return immutable && !(flags & GL_DYNAMIC_STORAGE_BIT);
}

void Replay::copyIntoBuffer(GLenum target, uint64_t offset, std::span<const std::byte> bytes) {
    GLint before = 0;
    GLuint between = 0;
    gl.glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &before);
    gl.glGenBuffers(1, &between);
    gl.glBindBuffer(GL_COPY_READ_BUFFER, between);
    gl.glBufferData(GL_COPY_READ_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_COPY);
    gl.glCopyBufferSubData(GL_COPY_READ_BUFFER, target, 0, static_cast<GLintptr>(offset),
                           static_cast<GLsizeiptr>(bytes.size()));
    gl.glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(before));
    gl.glDeleteBuffers(1, &between);
}

} // namespace mural
