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
    const auto number = static_cast<GLsizei>(counts.size());
    if (draw.instances != 1) { // never cut
        gl.glDrawArraysInstanced(draw.mode, firsts[0], counts[0], static_cast<GLsizei>(draw.instances));
    } else if (draw.indexType == 0) {
        gl.glMultiDrawArrays(draw.mode, firsts.data(), counts.data(), number);
    } else if (draw.first == 0) {
        gl.glMultiDrawElements(draw.mode, counts.data(), draw.indexType, offsets.data(), number);
    } else {
        gl.glMultiDrawElementsBaseVertex(draw.mode, counts.data(), draw.indexType, offsets.data(), number,
                                         bases.data());
    }
}

// The masks of all buffers. Commands in display lists set them without the replay's knowledge.
Replay::DriverColorMasks Replay::driverColorMasks() const {
    DriverColorMasks masks{};
    gl.glGetBooleanv(GL_COLOR_WRITEMASK, masks[0].data());
    for (GLuint i = 0; c_->version >= 30 && i < masks.size(); ++i)
        gl.glGetBooleani_v(GL_COLOR_WRITEMASK, i, masks[i].data());
    return masks;
}

void Replay::restoreDriverColorMasks(const DriverColorMasks& masks) {
    if (c_->version < 30) return gl.glColorMask(masks[0][0], masks[0][1], masks[0][2], masks[0][3]);
    for (GLuint i = 0; i < masks.size(); ++i) gl.glColorMaski(i, masks[i][0], masks[i][1], masks[i][2], masks[i][3]);
}

// Counts the samples in this node's area of the omitted parts of a draw. Changes no pixel.
void Replay::auditDraw(const replay::CullingDraw& draw, culling::Cut cut) {
    std::vector<culling::VertexRange> rest = cut == culling::Cut::Nothing
                                                 ? std::vector<culling::VertexRange>{{0, draw.count}}
                                                 : restOf(draw, culling_->ranges);
    withQueriesSuspended([&] {
        bool isOn[std::size(kHidingCaps)] = {};
        for (size_t i = 0; i < std::size(kHidingCaps); ++i) {
            if (c_->core && kHidingCaps[i] == GL_ALPHA_TEST) continue;
            isOn[i] = gl.glIsEnabled(kHidingCaps[i]) != GL_FALSE;
            if (isOn[i]) gl.glDisable(kHidingCaps[i]);
        }
        GLboolean depthMask = GL_FALSE;
        gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask);
        const auto colorMasks = driverColorMasks();
        gl.glDepthMask(GL_FALSE);
        gl.glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        if (!culling_->auditQuery) gl.glGenQueries(1, &culling_->auditQuery);
        gl.glBeginQuery(GL_SAMPLES_PASSED, culling_->auditQuery);
        issue(draw, rest);
        gl.glEndQuery(GL_SAMPLES_PASSED);
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
