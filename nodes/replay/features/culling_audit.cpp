// Draws parts of draws for culling: the kept ranges, and what the audit counts.
#include <algorithm>
#include <vector>

#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/culling.hpp"

namespace mural {

namespace {

// State that hides samples from a query.
constexpr GLenum kHidingCaps[] = {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_ALPHA_TEST};

// The ranges between the kept ones, with the vertices that they share with these.
std::vector<culling::VertexRange> restOf(const replay::CullingDraw& draw, std::span<const culling::VertexRange> kept) {
    const uint64_t overlap = culling::formOf(draw.mode).overlap;
    std::vector<culling::VertexRange> rest;
    uint64_t from = 0;
    const auto add = [&](uint64_t to) {
        if (to > from) rest.push_back({from, to - from});
    };
    for (const culling::VertexRange& range : kept) {
        add(std::min(range.first + overlap, draw.count));
        from = range.first + range.count - overlap;
    }
    add(draw.count);
    return rest;
}

} // namespace

// Draws the ranges of the draw, in their order.
void Replay::issue(const replay::CullingDraw& draw, std::span<const culling::VertexRange> ranges) {
    std::vector<GLsizei> counts;
    std::vector<GLint> firsts, bases;
    std::vector<const void*> offsets;
    for (const culling::VertexRange& range : ranges) {
        counts.push_back(static_cast<GLsizei>(range.count));
        firsts.push_back(static_cast<GLint>(draw.first + static_cast<int64_t>(range.first)));
        bases.push_back(static_cast<GLint>(draw.first));
        offsets.push_back(
            reinterpret_cast<const void*>(draw.indexOffset + range.first * replay::indexBytesOf(draw.indexType)));
    }
    if (draw.instances != 1 || esContext()) {
        for (size_t i = 0; i < counts.size(); ++i) issueOne(draw, firsts[i], counts[i], offsets[i]);
        return;
    }
    const auto number = static_cast<GLsizei>(counts.size());
    if (draw.indexType == 0) {
        gl.glMultiDrawArrays(draw.mode, firsts.data(), counts.data(), number);
    } else if (draw.first == 0) {
        gl.glMultiDrawElements(draw.mode, counts.data(), draw.indexType, offsets.data(), number);
    } else {
        gl.glMultiDrawElementsBaseVertex(draw.mode, counts.data(), draw.indexType, offsets.data(), number,
                                         bases.data());
    }
}

// A part of a draw by a command of its own: draws with instances, and of OpenGL ES, which has no glMultiDraw.
void Replay::issueOne(const replay::CullingDraw& draw, GLint first, GLsizei count, const void* indices) const {
    const auto instances = static_cast<GLsizei>(draw.instances);
    const auto base = static_cast<GLint>(draw.first);
    if (draw.indexType == 0 && instances == 1)
        gl.glDrawArrays(draw.mode, first, count);
    else if (draw.indexType == 0)
        gl.glDrawArraysInstanced(draw.mode, first, count, instances);
    else if (base == 0 && instances == 1)
        gl.glDrawElements(draw.mode, count, draw.indexType, indices);
    else if (base == 0)
        gl.glDrawElementsInstanced(draw.mode, count, draw.indexType, indices, instances);
    else
        gl.glDrawElementsInstancedBaseVertex(draw.mode, count, draw.indexType, indices, instances, base);
}

bool Replay::hasMasksOfBuffers() const { return c_->version >= (esContext() ? 32 : 30); }

// The masks of all buffers. Commands in display lists set them without the replay's knowledge.
Replay::DriverColorMasks Replay::driverColorMasks() const {
    DriverColorMasks masks{};
    gl.glGetBooleanv(GL_COLOR_WRITEMASK, masks[0].data());
    for (GLuint i = 0; hasMasksOfBuffers() && i < masks.size(); ++i)
        gl.glGetBooleani_v(GL_COLOR_WRITEMASK, i, masks[i].data());
    return masks;
}

void Replay::restoreDriverColorMasks(const DriverColorMasks& masks) {
    if (!hasMasksOfBuffers()) return gl.glColorMask(masks[0][0], masks[0][1], masks[0][2], masks[0][3]);
    for (GLuint i = 0; i < masks.size(); ++i) gl.glColorMaski(i, masks[i][0], masks[i][1], masks[i][2], masks[i][3]);
}

void Replay::auditDraw(const replay::CullingDraw& draw, culling::Cut cut) {
    auditSamples([&] {
        if (cut == culling::Cut::Nothing)
            issue(draw, std::vector<culling::VertexRange>{{0, draw.count}});
        else
            issue(draw, restOf(draw, culling_->ranges));
    });
}

// Counts the samples that `draw` covers in this node's area: it draws the left-out vertices. Changes no pixel.
void Replay::auditSamples(const std::function<void()>& draw) {
    withQueriesSuspended([&] {
        bool isOn[std::size(kHidingCaps)] = {};
        for (size_t i = 0; i < std::size(kHidingCaps); ++i) {
            if (kHidingCaps[i] == GL_ALPHA_TEST && !cullingOf(*c_).state.facts.hasMatrices) continue;
            isOn[i] = gl.glIsEnabled(kHidingCaps[i]) != GL_FALSE;
            if (isOn[i]) gl.glDisable(kHidingCaps[i]);
        }
        GLboolean depthMask = GL_FALSE;
        gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask);
        const auto colorMasks = driverColorMasks();
        gl.glDepthMask(GL_FALSE);
        gl.glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        if (!culling_->auditQuery) gl.glGenQueries(1, &culling_->auditQuery);
        const GLenum target = esContext() ? GL_ANY_SAMPLES_PASSED : GL_SAMPLES_PASSED;
        gl.glBeginQuery(target, culling_->auditQuery);
        draw();
        gl.glEndQuery(target);
        GLuint samples = 0;
        if (c_->queryBuffer) gl.glBindBuffer(GL_QUERY_BUFFER, 0);
        gl.glGetQueryObjectuiv(culling_->auditQuery, GL_QUERY_RESULT, &samples);
        if (c_->queryBuffer) gl.glBindBuffer(GL_QUERY_BUFFER, c_->queryBuffer);
        for (size_t i = 0; i < std::size(kHidingCaps); ++i)
            if (isOn[i]) gl.glEnable(kHidingCaps[i]);
        gl.glDepthMask(depthMask);
        restoreDriverColorMasks(colorMasks);
        ++counts_.culling.audits;
        if (samples == 0) return;
        if (counts_.culling.faults++ == 0)
            log::error(log::Topic::Replay, "culling audit: " + std::to_string(samples) +
                                               " samples of a draw that was left out are in the tiles of node " +
                                               std::to_string(config_.node) + ", in frame " +
                                               std::to_string(counts_.frames));
    });
}

} // namespace mural
