// Boxes of a draw's vertices, from the buffers of this node's GL.
#include <algorithm>

#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/culling.hpp"

namespace mural {

namespace {

// Draws with more bytes of vertices are not boxed.
constexpr uint64_t kMaxVertexBytes = uint64_t{1} << 30;

} // namespace

// Reads a part of a buffer. Returns nothing if the buffer is shorter.
std::optional<std::vector<std::byte>> Replay::bytesOfBuffer(GLuint buffer, uint64_t offset, uint64_t sizeBytes) {
    if (sizeBytes > kMaxVertexBytes || offset > INT64_MAX - sizeBytes) return std::nullopt;
    if (c_->version >= 42 && gl.glMemoryBarrier) gl.glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // writes of shaders
    gl.glBindBuffer(GL_ARRAY_BUFFER, buffer);
    GLint there = 0;
    gl.glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_SIZE, &there);
    std::optional<std::vector<std::byte>> bytes;
    if (offset + sizeBytes <= static_cast<uint64_t>(std::max(there, 0))) {
        bytes.emplace(sizeBytes);
        gl.glGetBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(sizeBytes),
                              bytes->data());
    }
    gl.glBindBuffer(GL_ARRAY_BUFFER, c_->arrayBuffer);
    return bytes;
}

culling::BoxCache::Entry& Replay::lookAtBoxes(const replay::CullingDraw& draw,
                                              std::span<const replay::CullingArray> arrays) {
    replay::ContextCulling& its = cullingOf(*c_);
    const auto& raster = its.state.raster(gl, c_->shared->culling);
    const culling::PrimitiveForm form = culling::formOf(draw.mode);
    std::optional<uint32_t> restart;
    if (draw.indexType && raster.restarts) restart = raster.restartIndex;
    if (draw.indexType && raster.restartsAtLargest)
        restart = static_cast<uint32_t>((uint64_t{1} << 8 * replay::indexBytesOf(draw.indexType)) - 1);
    const GLuint indices = draw.indexType ? its.state.indexBuffer(gl) : 0;
    culling::BoxKey key;
    key.add(uint64_t{form.step} << 32 | form.overlap);
    key.add(draw.count);
    key.add(static_cast<uint64_t>(draw.first));
    key.add(uint64_t{draw.indexType} << 1 | (restart ? 1 : 0));
    key.add(restart.value_or(0));
    key.add(draw.indexOffset);
    key.add(indices ? c_->shared->culling.contentsOf(indices) : 0);
    for (const replay::CullingArray& array : arrays) {
        key.add(c_->shared->culling.contentsOf(array.buffer));
        key.add(array.offset);
        key.add(array.stride << 1 | (array.isNormalized ? 1 : 0));
        key.add(uint64_t{array.type} << 32 | static_cast<uint32_t>(array.components));
    }
    culling::BoxCache::Entry& entry = culling_->boxes.look(key);
    if (!key.isComplete()) entry.isImpossible = true;
    if (entry.wantsBoxes()) {
        auto boxes = makeBoxesOf(draw, arrays, indices, restart);
        culling_->boxes.store(boxes ? std::make_shared<culling::DrawBoxes>(std::move(*boxes)) : nullptr);
        counts_.culling.boxBytes = culling_->boxes.peakBytes();
    }
    return entry;
}

std::optional<culling::DrawBoxes> Replay::makeBoxesOf(const replay::CullingDraw& draw,
                                                      std::span<const replay::CullingArray> arrays, GLuint indices,
                                                      std::optional<uint32_t> restart) {
    culling::VertexSequence sequence;
    sequence.count = draw.count;
    sequence.restart = restart;
    int64_t lowest = draw.first, highest = draw.first + static_cast<int64_t>(draw.count) - 1;
    std::optional<std::vector<std::byte>> indexMemory;
    if (draw.indexType) {
        sequence.indexBytes = replay::indexBytesOf(draw.indexType);
        if (indices == 0 || sequence.indexBytes == 0) return std::nullopt;
        indexMemory = bytesOfBuffer(indices, draw.indexOffset, draw.count * sequence.indexBytes);
        if (!indexMemory) return std::nullopt;
        sequence.indices = *indexMemory;
        const auto bounds = culling::indexBounds(sequence);
        if (!bounds) return std::nullopt;
        sequence.first = -int64_t{bounds->lowest}; // the bytes begin with the lowest index
        lowest = draw.first + int64_t{bounds->lowest};
        highest = draw.first + int64_t{bounds->highest};
    }
    if (lowest < 0 || draw.count == 0) return std::nullopt;
    std::vector<std::vector<std::byte>> memory;
    std::vector<culling::AttributeArray> read;
    for (const replay::CullingArray& array : arrays) {
        if (array.components < 1 || array.components > 4) return std::nullopt; // such as GL_BGRA
        culling::AttributeArray a{
            {}, array.stride, array.type, static_cast<uint32_t>(array.components), array.isNormalized};
        const uint64_t element = culling::elementBytes(a);
        if (element == 0 || array.stride == 0) return std::nullopt;
        const uint64_t span = static_cast<uint64_t>(highest - lowest) * array.stride + element;
        auto bytes = bytesOfBuffer(array.buffer, array.offset + static_cast<uint64_t>(lowest) * array.stride, span);
        if (!bytes) return std::nullopt;
        memory.push_back(std::move(*bytes));
        a.bytes = memory.back();
        read.push_back(a);
    }
    return culling::makeBoxes(read, sequence, culling::formOf(draw.mode));
}

} // namespace mural
