#include "interposer/encode/control_record_writer.hpp"

namespace mural::records {

namespace {
template <class... T> constexpr uint32_t kBytesOf = (0 + ... + (sizeof(T) == 8 ? 8 : 4));

template <class... T> void putAll(Writer& w, T... values) {
    [[maybe_unused]] const auto put = [&](auto v) {
        if constexpr (sizeof(v) == 8)
            w.put8(v);
        else
            w.put4(v);
    };
    (put(values), ...);
}

// Writes a record of fixed size from plain values.
template <class... T> bool fixed(ThreadState& t, uint16_t opcode, T... values) {
    constexpr uint32_t kSize = 4 + kBytesOf<T...>;
    std::byte* p = beginRecord(t, opcode, kSize);
    if (!p) return false;
    Writer w{p};
    putAll(w, values...);
    endRecord(t, p, kSize);
    return true;
}

// Writes plain values, then the data at a pointer.
template <class... T> void withData(ThreadState& t, uint16_t opcode, const DataArg& data, T... values) {
    spillLarge(t, data);
    const uint32_t size = 4 + kBytesOf<T...> + wireBytes(data);
    std::byte* p = beginRecord(t, opcode, size);
    if (!p) return;
    Writer w{p};
    putAll(w, values...);
    w.data(data);
    endRecord(t, p, size);
}

void withConfig(ThreadState& t, uint16_t opcode, const uint32_t* words, uint32_t count,
                const wire::WindowConfig& config) {
    const uint32_t size = 4 + 4 * count + sizeof config;
    std::byte* p = beginRecord(t, opcode, size);
    if (!p) return;
    Writer w{p};
    w.bytes(words, 4 * count);
    w.bytes(&config, sizeof config);
    endRecord(t, p, size);
}
} // namespace

void blobBegin(ThreadState& t, uint64_t sizeBytes) { fixed(t, wire::kOpBlobBegin, sizeBytes); }

bool blobData(ThreadState& t, const void* data, uint32_t sizeBytes) {
    const uint32_t size = 8 + (sizeBytes + 3) / 4 * 4;
    std::byte* p = beginRecord(t, wire::kOpBlobData, size);
    if (!p) return false;
    Writer w{p};
    w.put4(sizeBytes);
    w.bytes(data, sizeBytes);
    endRecord(t, p, size);
    return true;
}

void createContext(ThreadState& t, const ContextInfo& i) {
    const uint32_t words[] = {i.context, i.shareContext, i.api, i.major, i.minor, i.profileMask, i.flags};
    withConfig(t, wire::kOpCreateContext, words, 7, i.config);
}
void destroyContext(ThreadState& t, uint32_t context) { fixed(t, wire::kOpDestroyContext, context); }
void makeCurrent(ThreadState& t, uint32_t context, uint32_t draw, uint32_t read) {
    fixed(t, wire::kOpMakeCurrent, context, draw, read);
}
void window(ThreadState& t, uint32_t window, const wire::WindowConfig& config) {
    withConfig(t, wire::kOpWindow, &window, 1, config);
}
void destroyWindow(ThreadState& t, uint32_t window) { fixed(t, wire::kOpDestroyWindow, window); }
void swap(ThreadState& t, uint32_t window, uint32_t frame) { fixed(t, wire::kOpSwap, window, frame); }

void frontPicture(ThreadState& t, uint32_t window, uint32_t frame) { fixed(t, wire::kOpFrontPicture, window, frame); }

void requestPixels(ThreadState& t, uint32_t request, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format, GLenum type,
                   uint32_t groupBytes) {
    fixed(t, wire::kOpRequestPixels, request, x, y, w, h, format, type, groupBytes);
}
void requestTexImage(ThreadState& t, uint32_t request, uint32_t byName, GLuint targetOrTexture, GLint level,
                     GLenum format, GLenum type, uint64_t sizeBytes) {
    fixed(t, wire::kOpRequestTexImage, request, byName, targetOrTexture, level, format, type, sizeBytes);
}
void requestQuery(ThreadState& t, uint32_t request, GLuint query, GLenum pname) {
    fixed(t, wire::kOpRequestQuery, request, query, pname);
}
void requestFinish(ThreadState& t, uint32_t request) { fixed(t, wire::kOpFinish, request); }
void beginConditional(ThreadState& t, bool draws) { fixed(t, wire::kOpBeginConditional, uint32_t{draws}); }
void requestProgram(ThreadState& t, uint32_t request, GLuint program) {
    fixed(t, wire::kOpRequestProgram, request, program);
}
void drawAll(ThreadState& t) { fixed(t, wire::kOpDrawAll); }
bool errorReported(ThreadState& t) { return fixed(t, wire::kOpErrorReported); }
void queryKnown(ThreadState& t, GLuint query, bool passed) { fixed(t, wire::kOpQueryKnown, query, uint32_t{passed}); }
void requestBuffer(ThreadState& t, uint32_t request, GLuint buffer, uint64_t offset, uint64_t sizeBytes) {
    fixed(t, wire::kOpRequestBuffer, request, buffer, offset, sizeBytes);
}

void fillWindow(ThreadState& t, GLint x, GLint y, GLsizei width, GLsizei height, uint32_t planes,
                const DataArg& pixels) {
    withData(t, wire::kOpFillWindow, pixels, x, y, width, height, planes);
}
void bufferBytes(ThreadState& t, GLuint buffer, uint64_t offset, const DataArg& bytes) {
    withData(t, wire::kOpBufferBytes, bytes, buffer, offset);
}
void programLayout(ThreadState& t, GLuint program, const DataArg& layout) {
    withData(t, wire::kOpProgramLayout, layout, program);
}

void createImage(ThreadState& t, const ImageInfo& i) {
    fixed(t, wire::kOpCreateImage, i.image, i.context, i.target, i.name, i.level, i.layer);
}
void destroyImage(ThreadState& t, uint64_t image) { fixed(t, wire::kOpDestroyImage, image); }
void programRecipe(ThreadState& t, GLuint program, const DataArg& recipe) {
    withData(t, wire::kOpProgramRecipe, recipe, program);
}

namespace {
// A span precedes its record as a blob if it is large, or if the record would not fit into a chunk.
constexpr uint32_t kMaxArrayRecordBytes = 128 * 1024;
constexpr uint32_t kSmallSpanBytes = 1024; // 72 of them always fit

uint32_t spanLimit(const DataArg* spans, uint32_t spanCount) {
    uint64_t inlineBytes = 0;
    for (uint32_t i = 0; i < spanCount; ++i) inlineBytes += wireBytes(spans[i]);
    return inlineBytes <= kMaxArrayRecordBytes ? record::kInlineBytes : kSmallSpanBytes;
}
} // namespace

void clientArrays(ThreadState& t, const client_arrays::ArrayRecord* arrays, uint32_t arrayCount, const DataArg* spans,
                  uint32_t spanCount) {
    const uint32_t limit = spanLimit(spans, spanCount);
    uint32_t size = 12 + arrayCount * static_cast<uint32_t>(sizeof(client_arrays::ArrayRecord));
    for (uint32_t i = 0; i < spanCount; ++i) {
        const bool ahead = spans[i].sizeBytes > limit;
        if (ahead) spill(t, spans[i]);
        size += ahead ? 4 : wireBytes(spans[i]);
    }
    std::byte* p = beginRecord(t, wire::kOpClientArrays, size);
    if (!p) return;
    Writer w{p};
    w.put4(arrayCount);
    w.put4(spanCount);
    w.bytes(arrays, arrayCount * static_cast<uint32_t>(sizeof(client_arrays::ArrayRecord)));
    for (uint32_t i = 0; i < spanCount; ++i) {
        if (spans[i].sizeBytes > limit)
            w.put4(record::kTagBlob);
        else
            w.data(spans[i]);
    }
    endRecord(t, p, size);
}

} // namespace mural::records
