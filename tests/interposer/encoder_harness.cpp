#include "tests/interposer/encoder_harness.hpp"

#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "common/ipc/capture_ring.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

namespace {
testing::EncoderHarness* harness = nullptr;
} // namespace

// ---- the session, whose other end is the harness

Session* Session::current() {
    // Session's members are private; this memory says "alive" and its members are never read.
    alignas(Session) static std::byte memory[sizeof(Session)];
    static Session* session = new (memory) Session;
    if (!harness) return nullptr;
    if (!harness->alive())
        session->die("the test says so");
    else
        session->alive_ = true;
    return session;
}
void Session::die(const char*) { alive_ = false; }
void Session::publish(ThreadState& t, bool, bool) { harness->publish(t); }
bool Session::takeChunk(ThreadState& t) { return harness->takeChunk(t); }

bool unpackBufferBound(const Context&) { return harness && harness->unpackBuffer(); }
sizes::PixelStore unpackStore(const Context&) { return {}; }
bool isTight(const sizes::ImageLayout& layout) {
    return !layout.bitmap && !layout.swapUnit && layout.rowStride == static_cast<ptrdiff_t>(layout.rowBytes) &&
           (layout.images <= 1 || layout.imageStride == layout.rowBytes * layout.rows);
}
void say(const char*, ...) {}
void beforeAwaitedDrawing(ThreadState&, uint32_t) {}
void flushPersistentMaps(ThreadState&) {}

// Replaces thread_state.cpp for one thread that never ends.
ThreadState* firstThread() { return nullptr; }
void* scratchMemory(ThreadState& t, size_t bytes) {
    if (bytes <= t.scratchBytes) return t.scratch;
    t.scratch = std::realloc(t.scratch, bytes);
    t.scratchBytes = bytes;
    return t.scratch;
}

namespace testing {

EncoderHarness::EncoderHarness() : chunk_(std::make_unique<std::byte[]>(capture::kChunkBytes)) {
    harness = this;
    context_.id = 1;
    context_.group = &group_;
    thread_.context = &context_;
}

EncoderHarness::~EncoderHarness() {
    std::free(thread_.scratch);
    harness = nullptr;
}

void EncoderHarness::publish(ThreadState& t) {
    if (t.chunk == UINT32_MAX) return;
    const std::byte* begin = chunk_.get() + t.publishedBytes;
    if (t.cursor > begin) published_.emplace_back(begin, static_cast<const std::byte*>(t.cursor));
    t.publishedBytes = static_cast<uint32_t>(t.cursor - chunk_.get());
}

// There is one chunk, which is reused after its contents have been copied.
bool EncoderHarness::takeChunk(ThreadState& t) {
    if (!alive_) return false;
    ++chunksTaken_;
    t.chunk = 0;
    t.publishedBytes = 0;
    t.cursor = chunk_.get();
    t.chunkEnd = t.limit = chunk_.get() + capture::kChunkBytes;
    return true;
}

std::vector<std::vector<std::byte>> EncoderHarness::takePackets() {
    publish(thread_);
    return std::exchange(published_, {});
}

std::vector<std::byte> EncoderHarness::takeBytes() {
    std::vector<std::byte> all;
    for (const auto& packet : takePackets()) all.insert(all.end(), packet.begin(), packet.end());
    return all;
}

void EncoderHarness::loseHead() { alive_ = false; }
void EncoderHarness::bindUnpackBuffer(bool bound) { unpackBuffer_ = bound; }

} // namespace testing
} // namespace mural
