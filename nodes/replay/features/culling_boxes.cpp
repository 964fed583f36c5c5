// Boxes of a draw's vertices, from the buffers of this node's GL.
#include <algorithm>
#include <cstring>

#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/culling.hpp"

namespace mural {

namespace {

// Draws with more bytes of vertices are not boxed.
constexpr uint64_t kMaxVertexBytes = uint64_t{1} << 30;
// Smaller draws with changing vertices are not boxed.
constexpr uint64_t kMinStreamedVertices = 64;
// Draws of one layout, before their vertices count as changing with each draw.
constexpr uint32_t kStreamedSightings = 3;
constexpr size_t kMaxStreamedDraws = 4096;

} // namespace

// Reads a part of a buffer. Returns nothing if the buffer is shorter.
std::optional<std::vector<std::byte>> Replay::bytesOfBuffer(GLuint buffer, uint64_t offset, uint64_t sizeBytes) {
    if (sizeBytes > kMaxVertexBytes || offset > INT64_MAX - sizeBytes) return std::nullopt;
    if (c_->version >= (esContext() ? 31 : 42) && gl.glMemoryBarrier)
        gl.glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // writes of shaders
    gl.glBindBuffer(GL_ARRAY_BUFFER, buffer);
    GLint there = 0;
    gl.glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_SIZE, &there);
    std::optional<std::vector<std::byte>> bytes;
    if (offset + sizeBytes <= static_cast<uint64_t>(std::max(there, 0))) {
        const auto from = static_cast<GLintptr>(offset);
        const auto size = static_cast<GLsizeiptr>(sizeBytes);
        bytes.emplace(sizeBytes);
        const void* mapped = nullptr;
        if (!esContext())
            gl.glGetBufferSubData(GL_ARRAY_BUFFER, from, size, bytes->data());
        else if ((mapped = gl.glMapBufferRange(GL_ARRAY_BUFFER, from, size, GL_MAP_READ_BIT)))
            std::memcpy(bytes->data(), mapped, sizeBytes);
        if (mapped) gl.glUnmapBuffer(GL_ARRAY_BUFFER);
        if (esContext() && !mapped) bytes.reset();
    }
    gl.glBindBuffer(GL_ARRAY_BUFFER, c_->arrayBuffer);
    return bytes;
}

// A part of the client memory that the program has sent. Returns nothing for other addresses.
std::optional<std::span<const std::byte>> Replay::clientBytes(uint64_t address, uint64_t sizeBytes) const {
    for (const std::vector<std::byte>& memory : c_->arrayMemory) {
        const auto begin = reinterpret_cast<uintptr_t>(memory.data());
        if (address < begin || address - begin > memory.size() || memory.size() - (address - begin) < sizeBytes)
            continue;
        return std::span(memory).subspan(address - begin, sizeBytes);
    }
    return std::nullopt;
}

// The boxes of a draw, from the cache or made for this draw alone. Returns nothing where it is drawn whole.
replay::FoundBoxes Replay::boxesOf(const replay::CullingDraw& draw, std::span<const replay::CullingArray> arrays,
                                   culling::WhyWhole& why) {
    const bool isClient = !draw.indices.empty() || std::ranges::any_of(arrays, [](const auto& a) { return !a.buffer; });
    if (!isClient) {
        culling::BoxCache::Entry& entry = lookAtBoxes(draw, arrays);
        if (entry.isImpossible) why = culling::WhyWhole::NotFinite;
        if (entry.boxes || entry.isImpossible) return {entry.boxes, &entry.payoff, false};
    }
    why = isClient ? culling::WhyWhole::ClientMemory : culling::WhyWhole::FirstUse;
    const replay::CullingState& state = cullingOf(*c_).state;
    if (!state.facts.isSoftware || draw.count < kMinStreamedVertices) return {};
    culling::BoxKey layout;
    layout.add(draw.mode);
    layout.add(draw.count);
    layout.add(draw.indexType);
    layout.add(c_->program);
    for (const replay::CullingArray& array : arrays) {
        layout.add(array.buffer);
        layout.add(array.stride);
        layout.add(uint64_t{array.type} << 32 | static_cast<uint32_t>(array.components));
    }
    if (culling_->streamed.size() > kMaxStreamedDraws) culling_->streamed.clear();
    auto& streamed = culling_->streamed[layout.hash()];
    ++streamed.sightings;
    if (streamed.payoff.isPaused()) streamed.payoff.skip();
    if (streamed.payoff.isPaused() || streamed.sightings < kStreamedSightings) return {};
    const GLuint indices = draw.indexType ? cullingOf(*c_).state.indexBuffer(gl) : 0;
    auto boxes = makeBoxesOf(draw, arrays, indices, restartOf(draw));
    why = boxes ? culling::WhyWhole::None : culling::WhyWhole::NotFinite;
    if (!boxes) return {};
    return {std::make_shared<culling::DrawBoxes>(std::move(*boxes)), &streamed.payoff, true};
}

// The index that restarts primitives.
std::optional<uint32_t> Replay::restartOf(const replay::CullingDraw& draw) {
    const auto& raster = cullingOf(*c_).state.raster(gl, c_->shared->culling);
    if (draw.indexType && raster.restartsAtLargest)
        return static_cast<uint32_t>((uint64_t{1} << 8 * replay::indexBytesOf(draw.indexType)) - 1);
    if (draw.indexType && raster.restarts) return raster.restartIndex;
    return std::nullopt;
}

culling::BoxCache::Entry& Replay::lookAtBoxes(const replay::CullingDraw& draw,
                                              std::span<const replay::CullingArray> arrays) {
    replay::ContextCulling& its = cullingOf(*c_);
    const culling::PrimitiveForm form = culling::formOf(draw.mode);
    const std::optional<uint32_t> restart = restartOf(draw);
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
        if (sequence.indexBytes == 0) return std::nullopt;
        if (indices) indexMemory = bytesOfBuffer(indices, draw.indexOffset, draw.count * sequence.indexBytes);
        if (indices && !indexMemory) return std::nullopt;
        sequence.indices = indices ? std::span<const std::byte>(*indexMemory) : draw.indices;
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
        const uint64_t at = array.offset + static_cast<uint64_t>(lowest) * array.stride;
        if (array.buffer == 0) {
            const auto bytes = clientBytes(at, span);
            if (!bytes) return std::nullopt;
            a.bytes = *bytes;
        } else {
            auto bytes = bytesOfBuffer(array.buffer, at, span);
            if (!bytes) return std::nullopt;
            memory.push_back(std::move(*bytes));
            a.bytes = memory.back();
        }
        read.push_back(a);
    }
    return culling::makeBoxes(read, sequence, culling::formOf(draw.mode));
}

} // namespace mural
