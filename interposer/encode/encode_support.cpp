#include "interposer/encode/encode_support.hpp"

#include "interposer/context/context.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/encode/group_order.hpp"
#include "interposer/diagnostics/command_counts.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/memory/readable.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {
Lock unsupportedLock; // guards CaptureHeader::unsupported

// Resets the thread's state for a program without capture, or after its end.
void goAlone(ThreadState& t) {
    t.cursor = t.limit = t.chunkEnd = nullptr;
    t.chunk = UINT32_MAX;
    t.drawLocally = t.vertexLocally = true;
}

// Commands that EGL and GLX allow without a current context.
bool needsNoContext(uint32_t opcode) {
    return opcode == wire::kOpCreateImage || opcode == wire::kOpDestroyImage || opcode == wire::kOpSwap;
}

// Takes the lock, because another thread may close the fast path at this moment (group_order::enter).
void openFastPath(ThreadState& t) {
    Guard guard(t.context->group->lock);
    t.limit = t.shared ? nullptr : t.chunkEnd;
}
} // namespace

std::byte* makeRoom(ThreadState& t, uint32_t opcode, uint32_t sizeBytes) {
    if (!t.context && !needsNoContext(opcode)) {
        t.drawLocally = t.vertexLocally = true; // a forked child finds its parent's state cleared to false
        return nullptr;
    }
    if (t.drawingAwaited) beforeAwaitedDrawing(t, opcode);
    Session* s = Session::current();
    if (!s || !s->alive()) {
        goAlone(t);
        return nullptr;
    }
    if (t.context && t.shared) group_order::takeTurn(t, *s);
    if (t.chunk == UINT32_MAX || t.cursor + sizeBytes > t.chunkEnd) {
        s->publish(t, true);
        if (!s->takeChunk(t)) {
            if (t.locked) unlockGroup(t);
            goAlone(t);
            return nullptr;
        }
    }
    if (t.context && !t.shared && !t.drawingAwaited) openFastPath(t);
    return t.cursor;
}

void unlockGroup(ThreadState& t) {
    t.locked = false;
    t.context->group->lock.unlock();
}

void spill(ThreadState& t, const DataArg& d) {
    if (!d.pointer) return;
    records::blobBegin(t, d.sizeBytes);
    const auto* p = static_cast<const std::byte*>(d.pointer);
    for (uint64_t done = 0; done < d.sizeBytes;) {
        const uint64_t left = d.sizeBytes - done;
        const auto piece = static_cast<uint32_t>(left < record::kBlobPieceBytes ? left : record::kBlobPieceBytes);
        if (!records::blobData(t, p + done, piece)) return;
        done += piece;
    }
}

static DataArg imageInMemory(ThreadState& t, const void* pixels, GLenum format, GLenum type, GLsizei width,
                             GLsizei height, GLsizei depth, int dimensions) {
    if (!pixels) return {};
    const sizes::ImageLayout layout =
        sizes::layoutOf(unpackStore(*t.context), format, type, width, height, depth, dimensions);
    const size_t tight = layout.known ? sizes::tightBytes(layout) : 0;
    if (tight == 0 || tight == SIZE_MAX) return {}; // the driver reports the error; the nodes receive no data
    if (isTight(layout)) return DataArg::of(static_cast<const std::byte*>(pixels) + layout.firstByte, tight);
    void* packed = scratchMemory(t, tight);
    if (!packed) return {};
    sizes::packTight(packed, pixels, layout);
    return DataArg::of(packed, tight);
}

DataArg imageSource(ThreadState& t, const void* pixels, GLenum format, GLenum type, GLsizei width, GLsizei height,
                    GLsizei depth, int dimensions) {
    if (!t.context) return {};
    if (unpackBufferBound(*t.context)) {
        buffersRead(t);
        return DataArg::offset(pixels);
    }
    return imageInMemory(t, pixels, format, type, width, height, depth, dimensions);
}

DataArg elementSource(ThreadState& t, const void* element, GLenum format, GLenum type) {
    return t.context ? imageInMemory(t, element, format, type, 1, 1, 1, 1) : DataArg{};
}

DataArg packedSource(ThreadState& t, const void* data, uint64_t sizeBytes) {
    if (!t.context) return {};
    if (unpackBufferBound(*t.context)) {
        buffersRead(t);
        return DataArg::offset(data);
    }
    return DataArg::of(data, sizeBytes);
}

DataArg packStrings(ThreadState& t, GLsizei count, const GLchar* const* strings, const GLint* lengths) {
    if (count <= 0 || !strings) return {};
    const auto n = static_cast<size_t>(count);
    const auto lengthOf = [&](size_t i) -> uint32_t {
        if (!strings[i]) return 0;
        return lengths && lengths[i] >= 0 ? static_cast<uint32_t>(lengths[i])
                                          : static_cast<uint32_t>(std::strlen(strings[i]));
    };
    size_t total = 4 * n;
    for (size_t i = 0; i < n; ++i) total += lengthOf(i);
    auto* out = static_cast<std::byte*>(scratchMemory(t, total));
    if (!out) return {};
    std::byte* text = out + 4 * n;
    for (size_t i = 0; i < n; ++i) {
        const uint32_t length = lengthOf(i);
        std::memcpy(out + 4 * i, &length, 4);
        if (length) std::memcpy(text, strings[i], length);
        text += length;
    }
    return DataArg::of(out, total);
}

GLsizei readableElements(const void* value, GLsizei count, uint32_t elementBytes) {
    constexpr uint64_t kMaxBytes = 256 * 1024; // all uniforms of a stage, far above the limits of drivers
    const uint64_t wanted = uint64_t(count) * elementBytes < kMaxBytes ? uint64_t(count) * elementBytes : kMaxBytes;
    return static_cast<GLsizei>(readableBytes(value, wanted) / elementBytes);
}

void unsupportedCalled(const char* name, const char* reason) {
    Session* s = Session::current();
    if (!s || !s->alive()) return;
    {
        Guard guard(unsupportedLock);
        countCommand(s->header()->unsupported, name);
    }
    if (s->header()->callsUnsupported.fetch_add(1, std::memory_order_relaxed) == 0)
        say("%s is not supported on the wall (%s); further such calls are only counted", name, reason);
}

} // namespace mural
