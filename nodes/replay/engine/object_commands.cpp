// Replays commands whose object names or pointers differ on this node.
#include <cstring>
#include <utility>

#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/sizes/vertex_types.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

// ---- buffers and vertex arrays

void Replay::glBindBuffer(GLenum target, GLuint buffer) {
    const GLuint nodeName = name(Kind::Buffer, buffer);
    if (target == GL_ARRAY_BUFFER) c_->arrayBuffer = nodeName;
    if (target == GL_PIXEL_PACK_BUFFER) c_->packBuffer = nodeName;
    if (target == GL_QUERY_BUFFER) c_->queryBuffer = nodeName;
    if (target == GL_PIXEL_UNPACK_BUFFER) c_->unpackBuffer = nodeName;
    gl.glBindBuffer(target, nodeName);
}
void Replay::glDeleteBuffers(GLsizei n, const Data& buffers) {
    if (n <= 0 || !buffers.pointer()) return;
    const GLuint* nodeNames = names(Kind::Buffer, buffers.as<GLuint>(), n);
    for (GLsizei i = 0; i < n; ++i) {
        if (nodeNames[i] == 0) continue;
        if (nodeNames[i] == c_->arrayBuffer) c_->arrayBuffer = 0;
        if (nodeNames[i] == c_->packBuffer) c_->packBuffer = 0;
        if (nodeNames[i] == c_->queryBuffer) c_->queryBuffer = 0;
        if (nodeNames[i] == c_->unpackBuffer) c_->unpackBuffer = 0;
    }
    gl.glDeleteBuffers(n, nodeNames);
    forget(Kind::Buffer, buffers.as<GLuint>(), n);
}
void Replay::glBindVertexArray(GLuint array) { gl.glBindVertexArray(name(Kind::VertexArray, array)); }

// Pointers here are offsets into buffers (client memory: kOpClientArrays). Without a bound buffer GL would access
// memory.
void Replay::arrayPointer(uint64_t pointer, const std::function<void(const void*)>& call) {
    if (c_->arrayBuffer == 0 && pointer != 0) return;
    call(reinterpret_cast<const void*>(pointer));
}
void Replay::glVertexPointer(GLint size, GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glVertexPointer(size, type, stride, p); });
}
void Replay::glNormalPointer(GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glNormalPointer(type, stride, p); });
}
void Replay::glColorPointer(GLint size, GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glColorPointer(size, type, stride, p); });
}
void Replay::glSecondaryColorPointer(GLint size, GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glSecondaryColorPointer(size, type, stride, p); });
}
void Replay::glTexCoordPointer(GLint size, GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glTexCoordPointer(size, type, stride, p); });
}
void Replay::glFogCoordPointer(GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glFogCoordPointer(type, stride, p); });
}
void Replay::glIndexPointer(GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glIndexPointer(type, stride, p); });
}
void Replay::glEdgeFlagPointer(GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glEdgeFlagPointer(stride, p); });
}
void Replay::glPointSizePointerOES(GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glPointSizePointerOES(type, stride, p); });
}
void Replay::glVertexAttribPointer(GLuint index, GLint size, GLenum type, GLboolean normalized, GLsizei stride,
                                   uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glVertexAttribPointer(index, size, type, normalized, stride, p); });
}
void Replay::glVertexAttribIPointer(GLuint index, GLint size, GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glVertexAttribIPointer(index, size, type, stride, p); });
}
void Replay::glVertexAttribLPointer(GLuint index, GLint size, GLenum type, GLsizei stride, uint64_t pointer) {
    arrayPointer(pointer, [&](const void* p) { gl.glVertexAttribLPointer(index, size, type, stride, p); });
}

namespace {
// Converts the indices of a multi-draw. Returns false if malformed.
bool indexPointers(const Data& indices, const GLsizei* count, GLenum type, GLsizei drawcount,
                   std::vector<const void*>& out) {
    const auto bytes = indices.span();
    if (bytes.size() < 8) return false;
    uint32_t kind = 0;
    std::memcpy(&kind, bytes.data(), 4);
    const uint32_t element = sizes::typeBytes(type);
    size_t at = 8;
    for (GLsizei i = 0; i < drawcount; ++i) {
        const size_t step = kind == 1 ? 8 : count[i] > 0 ? size_t{element} * static_cast<size_t>(count[i]) : 0;
        if (step > bytes.size() - at) return false;
        uint64_t offset = 0;
        if (kind == 1) std::memcpy(&offset, bytes.data() + at, 8);
        out.push_back(kind == 1 ? reinterpret_cast<const void*>(offset) : bytes.data() + at);
        at += step;
    }
    return true;
}
} // namespace

// Offsets require a bound index buffer, pointers require none.
bool Replay::indicesFit(const Data& indices) {
    uint32_t kind = 0;
    GLint buffer = 0;
    if (indices.span().size() < 8) return false;
    std::memcpy(&kind, indices.span().data(), 4);
    gl.glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &buffer);
    return (kind == 1) == (buffer != 0);
}

void Replay::glMultiDrawElements(GLenum mode, const Data& count, GLenum type, const Data& indices, GLsizei drawcount) {
    std::vector<const void*> pointers;
    if (drawcount > 0 && count.pointer() && indicesFit(indices) &&
        indexPointers(indices, count.as<GLsizei>(), type, drawcount, pointers))
        gl.glMultiDrawElements(mode, count.as<GLsizei>(), type, pointers.data(), drawcount);
}
void Replay::glMultiDrawElementsBaseVertex(GLenum mode, const Data& count, GLenum type, const Data& indices,
                                           GLsizei drawcount, const Data& basevertex) {
    std::vector<const void*> pointers;
    if (drawcount > 0 && count.pointer() && basevertex.pointer() && indicesFit(indices) &&
        indexPointers(indices, count.as<GLsizei>(), type, drawcount, pointers))
        gl.glMultiDrawElementsBaseVertex(mode, count.as<GLsizei>(), type, pointers.data(), drawcount,
                                         basevertex.as<GLint>());
}

// ---- programs

void Replay::glUniformBlockBinding(GLuint program, GLuint index, GLuint binding) {
    gl.glUniformBlockBinding(name(Kind::Program, program), index, binding);
}
void Replay::glShaderStorageBlockBinding(GLuint program, GLuint index, GLuint binding) {
    gl.glShaderStorageBlockBinding(name(Kind::Program, program), index, binding);
}

void Replay::glCopyImageSubData(GLuint srcName, GLenum srcTarget, GLint srcLevel, GLint srcX, GLint srcY, GLint srcZ,
                                GLuint dstName, GLenum dstTarget, GLint dstLevel, GLint dstX, GLint dstY, GLint dstZ,
                                GLsizei w, GLsizei h, GLsizei d) {
    if (!gl.glCopyImageSubData) return;
    const auto nodeName = [&](GLuint n, GLenum target) {
        return name(target == GL_RENDERBUFFER ? Kind::Renderbuffer : Kind::Texture, n);
    };
    gl.glCopyImageSubData(nodeName(srcName, srcTarget), srcTarget, srcLevel, srcX, srcY, srcZ,
                          nodeName(dstName, dstTarget), dstTarget, dstLevel, dstX, dstY, dstZ, w, h, d);
}

void Replay::glCopyImageSubDataNV(GLuint srcName, GLenum srcTarget, GLint srcLevel, GLint srcX, GLint srcY, GLint srcZ,
                                  GLuint dstName, GLenum dstTarget, GLint dstLevel, GLint dstX, GLint dstY, GLint dstZ,
                                  GLsizei w, GLsizei h, GLsizei d) {
    glCopyImageSubData(srcName, srcTarget, srcLevel, srcX, srcY, srcZ, dstName, dstTarget, dstLevel, dstX, dstY, dstZ,
                       w, h, d);
}

// ---- synchronisation: one thread replays all contexts in the program's order

void Replay::glFenceSync(GLenum condition, GLbitfield flags, uint64_t result) {
    if (gl.glFenceSync && c_->shared) c_->shared->syncs[result] = gl.glFenceSync(condition, flags);
}
void Replay::glWaitSync(uint64_t sync, GLbitfield flags, GLuint64 timeout) {
    if (!c_->shared) return;
    const auto it = c_->shared->syncs.find(sync);
    if (it != c_->shared->syncs.end() && it->second) gl.glWaitSync(it->second, flags, timeout);
}
void Replay::glDeleteSync(uint64_t sync) {
    if (!c_->shared) return;
    const auto it = c_->shared->syncs.find(sync);
    if (it == c_->shared->syncs.end()) return;
    if (it->second) gl.glDeleteSync(it->second);
    c_->shared->syncs.erase(it);
}
// The program's own context has already waited where it matters. A node need not stall its stream.
void Replay::glFinish() { gl.glFlush(); }

// Feedback and selection run in the program's own context. Nothing is drawn meanwhile.
void Replay::glRenderMode(GLenum mode) {
    if (mode == GL_RENDER) {
        if (gl.glRenderMode) gl.glRenderMode(GL_RENDER);
        return;
    }
    if (!gl.glRenderMode) return;
    static GLuint nowhere[64];
    static GLfloat nothing[64];
    if (mode == GL_SELECT)
        gl.glSelectBuffer(64, nowhere);
    else
        gl.glFeedbackBuffer(64, GL_2D, nothing);
    gl.glRenderMode(mode);
}

namespace {
constexpr int kListNesting = 64; // GL_MAX_LIST_NESTING: bounds recursive lists

class ItemBlobs : public BlobQueue {
public:
    explicit ItemBlobs(const std::vector<std::vector<std::byte>>& blobs) : blobs_(blobs) {}
    std::span<const std::byte> takeBlob(bool& found) override {
        found = next_ < blobs_.size();
        return found ? std::span<const std::byte>(blobs_[next_++]) : std::span<const std::byte>{};
    }

private:
    const std::vector<std::vector<std::byte>>& blobs_;
    size_t next_ = 0;
};
} // namespace

// ---- display lists. A list of the program is one native list, or several with commands between them. The node
// executes these commands itself, because they depend on its tile or on the program's names.

bool Replay::splitsLists(uint16_t opcode, std::span<const std::byte> arguments) const {
    switch (effectOf(opcode).list) {
    case ListRole::Native: return false;
    case ListRole::Split: return true;
    case ListRole::SplitForScissor: {
        uint32_t cap = 0;
        if (arguments.size() >= 4) std::memcpy(&cap, arguments.data(), 4);
        return cap == GL_SCISSOR_TEST;
    }
    case ListRole::SplitForAlpha: return alphaHides_;
    case ListRole::SplitForViewport: return config_.lean || movesPicture() || rewrites().any();
    case ListRole::SplitForTile: return config_.lean;
    }
    return false;
}

// Called during list compilation. An invalid glBegin starts no primitive.
void Replay::onPrimitive(uint16_t opcode, std::span<const std::byte> arguments) {
    if (hasTrait(opcode, Trait::End)) c_->compilesPrimitive = false;
    uint32_t mode = GL_PATCHES + 1;
    if (hasTrait(opcode, Trait::Begin) && arguments.size() >= 4) std::memcpy(&mode, arguments.data(), 4);
    if (mode <= GL_PATCHES) c_->compilesPrimitive = true;
}

// Compiles a command that splits lists. Between glBegin and glEnd, GL accepts only calls of lists among these commands.
// The others are errors there. The program's own list raises these errors. Here they would end the native list inside
// its primitive. A list cannot be ended during the execution of a primitive either, so lists that are called there are
// called natively.
bool Replay::compileSplitting(uint16_t opcode, std::span<const std::byte> bytes, std::span<const std::byte> arguments) {
    const bool callsList = hasTrait(opcode, Trait::CallList);
    if (c_->compilesPrimitive && !callsList) {
        for (bool found = true; found;) takeBlob(found);
        return true;
    }
    if (c_->compilesPrimitive && c_->compileMode == GL_COMPILE_AND_EXECUTE) return execute(opcode, arguments, *this);
    compileSplit(bytes);
    return true;
}

void Replay::glNewList(GLuint list, GLenum mode) {
    if (c_->compiling || list == 0) return;
    c_->compileMode = mode;
    onTurnOfList();
    c_->compiling = list;
    c_->compilesPrimitive = false;
    c_->building = {};
    const GLuint first = gl.glGenLists(1);
    c_->building.items.push_back({.native = first, .record = {}, .blobs = {}, .primitives = {}});
    gl.glNewList(first, mode); // compile-and-execute is left to the driver: list playback may draw differently
}
void Replay::glEndList() {
    if (!c_->compiling) return;
    gl.glEndList();
    if (culling_) endListSection();
    const GLuint list = c_->compiling;
    c_->compiling = 0;
    applyTileValues(); // the values may have changed during compilation
    DisplayList& slot = c_->shared->lists[list];
    deleteNativeLists(slot);
    slot = std::move(c_->building);
    c_->building = {};
}

void Replay::deleteNativeLists(const DisplayList& list) {
    for (const DisplayListItem& item : list.items) {
        if (item.record.empty()) gl.glDeleteLists(item.native, 1);
        if (item.primitives && item.primitives->after) gl.glDeleteLists(item.primitives->after, 1);
    }
}

// Stores a command that a native list cannot contain between two native lists. Its blobs are stored with it, because
// the list may be called repeatedly.
void Replay::compileSplit(std::span<const std::byte> bytes) {
    DisplayListItem item{.record = {bytes.begin(), bytes.end()}, .blobs = {}, .primitives = {}};
    for (bool found = true; found;) {
        takeBlob(found);
        if (found) item.blobs.push_back(std::move(taken_.back()));
    }
    c_->building.items.push_back(std::move(item));
    nextNativeList([&] {
        if (c_->compileMode == GL_COMPILE_AND_EXECUTE) runItem(c_->building.items.back());
    });
}

// Continues with another native list. Calls made in `between` are in no list.
void Replay::nextNativeList(const std::function<void()>& between) {
    gl.glEndList();
    if (culling_) endListSection();
    const GLuint compiling = std::exchange(c_->compiling, 0);
    between();
    onTurnOfList();
    c_->compiling = compiling;
    const GLuint next = gl.glGenLists(1);
    c_->building.items.push_back({.native = next, .record = {}, .blobs = {}, .primitives = {}});
    gl.glNewList(next, c_->compileMode);
}

void Replay::glCallList(GLuint list) {
    if (listDepth_ == 0) listCommands_ = 0;
    if (listDepth_ >= kListNesting) return;
    ++listDepth_;
    runList(list);
    --listDepth_;
}

void Replay::runList(GLuint list) {
    const auto it = c_->shared->lists.find(list);
    if (it == c_->shared->lists.end()) return;
    for (const DisplayListItem& item : it->second.items) {
        if (++listCommands_ > config_.limits.listCommands) return;
        if (item.record.empty()) {
            if (takesRanges() && !c_->compiling && !onRangeList(item)) c_->rangeKnown = false;
            if (moves()) onNativeList();
            if (culling_ && cullListed(item)) continue;
            gl.glCallList(item.native);
            continue;
        }
        runItem(item);
    }
}

// Executes a list command that is not in a native list.
void Replay::runItem(const DisplayListItem& item) {
    uint32_t header = 0;
    std::memcpy(&header, item.record.data(), 4);
    const std::span<const std::byte> bytes = item.record;
    ItemBlobs blobs(item.blobs);
    const size_t used = scratchUsed_;
    execute(static_cast<uint16_t>(header & 0xffff), bytes.subspan(record::headerBytesOf(header)), blobs);
    scratchUsed_ = used; // releases this command's temporary names, not the caller's
}
void Replay::glCallLists(GLsizei n, GLenum type, const Data& lists) {
    if (!lists.pointer()) return;
    const auto* p = lists.as<uint8_t>();
    const auto read = [&]<class T>(GLsizei i, T) {
        T value{};
        std::memcpy(&value, p + static_cast<size_t>(i) * sizeof(T), sizeof(T));
        return static_cast<GLuint>(static_cast<int64_t>(value));
    };
    for (GLsizei i = 0; i < n; ++i) {
        GLuint offset = 0;
        const auto* b = p + static_cast<size_t>(i) * (type == GL_2_BYTES ? 2 : type == GL_3_BYTES ? 3 : 4);
        switch (type) {
        case GL_BYTE: offset = read(i, GLbyte{}); break;
        case GL_UNSIGNED_BYTE: offset = read(i, GLubyte{}); break;
        case GL_SHORT: offset = read(i, GLshort{}); break;
        case GL_UNSIGNED_SHORT: offset = read(i, GLushort{}); break;
        case GL_INT: offset = read(i, GLint{}); break;
        case GL_UNSIGNED_INT: offset = read(i, GLuint{}); break;
        case GL_FLOAT: offset = read(i, GLfloat{}); break;
        case GL_2_BYTES: offset = GLuint{b[0]} * 256 + b[1]; break;
        case GL_3_BYTES: offset = GLuint{b[0]} * 65536 + GLuint{b[1]} * 256 + b[2]; break;
        case GL_4_BYTES: offset = GLuint{b[0]} << 24 | GLuint{b[1]} << 16 | GLuint{b[2]} << 8 | b[3]; break;
        default: return;
        }
        glCallList(c_->listBase + offset);
    }
}
void Replay::glListBase(GLuint base) { c_->listBase = base; }
void Replay::glGenLists(GLsizei, GLuint) {} // native lists are created on demand
void Replay::glDeleteLists(GLuint list, GLsizei range) {
    auto& lists = c_->shared->lists;
    for (GLsizei i = 0; i < range && !lists.empty(); ++i) {
        const auto it = lists.find(list + static_cast<GLuint>(i));
        if (it == lists.end()) {
            if (range > 1 << 16 && i > 1 << 16) break; // an implausible range: deletes existing lists only
            continue;
        }
        deleteNativeLists(it->second);
        lists.erase(it);
    }
}

} // namespace mural
