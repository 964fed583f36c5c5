// Queries over tiles. Fragments that a node draws only in its tile are added to the other nodes' counts. Fragments that
// every node draws (framebuffer objects, drawn pixels, memory-writing shaders) count once. A change between the two
// cuts a query into pieces.
#include <algorithm>
#include <utility>

#include "common/ipc/capture_ring.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

namespace {

bool countsSamples(GLenum target) {
    return target == GL_SAMPLES_PASSED || target == GL_ANY_SAMPLES_PASSED ||
           target == GL_ANY_SAMPLES_PASSED_CONSERVATIVE;
}
// Whether culling of primitives outside the tile would change the count.
bool countsClipping(GLenum target) {
    return target == GL_CLIPPING_INPUT_PRIMITIVES || target == GL_CLIPPING_OUTPUT_PRIMITIVES;
}

} // namespace

// Returns true if every node currently draws the same pixels, not only its own.
bool Replay::isReplicatedDraw() const {
    return !drawsWindow() ||
           (!drawsLean() && (tileOff_ || allDrawn() || c_->countedWhole || drawsOldFront() ||
                             (c_->draw && (isLearningTurns(*c_->draw) || isLearningAreas(*c_->draw)))));
}

// Must be called after any change of isReplicatedDraw(), before the next draw.
void Replay::splitQueries() {
    const bool whole = isReplicatedDraw();
    if (whole == std::exchange(c_->countsWhole, whole) || c_->compiling) return;
    for (const auto& [target, id] : c_->counting) {
        gl.glEndQuery(target);
        beginPiece(target, id);
    }
}

void Replay::beginPiece(GLenum target, GLuint query) {
    GLuint nodeName = 0;
    gl.glGenQueries(1, &nodeName);
    gl.glBeginQuery(target, nodeName);
    c_->queries[query].pieces.push_back({nodeName, isReplicatedDraw()});
}

// Runs draws of the replay itself: no condition skips them, and no query counts them.
void Replay::withQueriesSuspended(const std::function<void()>& call) {
    if (c_->conditional) gl.glEndConditionalRender();
    for (const auto& [target, id] : c_->counting) gl.glEndQuery(target);
    call();
    for (const auto& [target, id] : c_->counting) beginPiece(target, id);
    if (c_->conditional) gl.glBeginConditionalRender(c_->condition, c_->conditionMode);
}

void Replay::dropPieces(QueryInfo& query) {
    // the first is the program's query
    for (size_t i = 1; i < query.pieces.size(); ++i) gl.glDeleteQueries(1, &query.pieces[i].nodeName);
    query.pieces.clear();
}

void Replay::glBeginQuery(GLenum target, GLuint id) {
    const GLuint nodeName = name(Kind::Query, id);
    QueryInfo& query = c_->queries[id];
    // their results are obsolete
    std::erase_if(c_->prefetches, [&](const replay::Prefetch& prefetch) { return prefetch.query == id; });
    dropPieces(query);
    query.target = target;
    query.skipped = c_->draw && c_->draw->skipped;
    // Regions of whole bins overlap, so overlapping fragments would count twice. Nodes with and without a GPU must
    // decide equally, so the window's buffers decide.
    const bool overlap =
        countsSamples(target) && drawsWindow() && c_->draw && (c_->draw->config.samples > 0 || c_->draw->isFlat);
    if (overlap || target == GL_FRAGMENT_SHADER_INVOCATIONS) {
        c_->countedWhole = true;
        applyScissors();
    }
    splitQueries();
    query.pieces.push_back({nodeName, isReplicatedDraw()});
    if (countsSamples(target) || target == GL_FRAGMENT_SHADER_INVOCATIONS) c_->counting[target] = id;
    gl.glBeginQuery(target, nodeName);
    c_->clippingCounted = c_->clippingCounted || countsClipping(target);
    if (!countsSamples(target)) c_->openQueries.insert(target);
    applyTileValues();
}

void Replay::glEndQuery(GLenum target) {
    gl.glEndQuery(target);
    c_->counting.erase(target);
    c_->openQueries.erase(target);
    if (countsClipping(target)) c_->clippingCounted = false;
    if (c_->counting.empty() && std::exchange(c_->countedWhole, false)) applyScissors();
    applyTileValues();
}

void Replay::glBeginQueryIndexed(GLenum target, GLuint index, GLuint id) {
    if (index == 0) return glBeginQuery(target, id);
    c_->openQueries.insert(target);
    if (gl.glBeginQueryIndexed) gl.glBeginQueryIndexed(target, index, name(Kind::Query, id));
}
void Replay::glEndQueryIndexed(GLenum target, GLuint index) {
    if (index == 0) return glEndQuery(target);
    c_->openQueries.erase(target);
    if (gl.glEndQueryIndexed) gl.glEndQueryIndexed(target, index);
}

void Replay::glDeleteQueries(GLsizei n, const Data& ids) {
    if (n <= 0 || !ids.pointer()) return;
    const auto* app = ids.as<GLuint>();
    gl.glDeleteQueries(n, names(Kind::Query, app, n));
    for (GLsizei i = 0; i < n; ++i) {
        const auto query = c_->queries.find(app[i]);
        if (query == c_->queries.end()) continue;
        std::erase_if(c_->counting, [&](const auto& active) { return active.second == app[i]; });
        std::erase_if(c_->prefetches, [&](const replay::Prefetch& prefetch) { return prefetch.query == app[i]; });
        dropPieces(query->second);
        c_->queries.erase(query);
    }
    forget(Kind::Query, app, n);
}

uint64_t Replay::queryResult(GLuint nodeName) {
    if (c_->queryBuffer) gl.glBindBuffer(GL_QUERY_BUFFER, 0);
    const uint64_t result = readQuery(nodeName);
    if (c_->queryBuffer) gl.glBindBuffer(GL_QUERY_BUFFER, c_->queryBuffer);
    return result;
}

uint64_t Replay::readQuery(GLuint nodeName) {
    if (gl.glGetQueryObjectui64v && c_->api == wire::Api::Desktop) {
        GLuint64 result = 0;
        gl.glGetQueryObjectui64v(nodeName, GL_QUERY_RESULT, &result);
        return result;
    }
    GLuint result = 0;
    if (gl.glGetQueryObjectuiv) gl.glGetQueryObjectuiv(nodeName, GL_QUERY_RESULT, &result);
    return result;
}

bool Replay::onRequestQuery(Args& in) {
    const auto request = in.get<uint32_t>(), query = in.get<uint32_t>(), pname = in.get<uint32_t>();
    if (!in.ok()) return false;
    constexpr size_t kMaxPrefetches = 65536;
    if ((request & capture::kPrefetched) && pname == GL_QUERY_RESULT && bound_) {
        if (c_->prefetches.size() < kMaxPrefetches) c_->prefetches.push_back({request, query});
    } else {
        answerQuery(request, query);
    }
    return true;
}

// Sends the results that were requested during the frame, after its end, so that they do not delay its drawing.
void Replay::sendPrefetched() {
    if (!bound_ || bound_->prefetches.empty()) return;
    ContextState* const own = std::exchange(c_, bound_);
    for (const replay::Prefetch& prefetch : std::exchange(c_->prefetches, {}))
        answerQuery(prefetch.request, prefetch.query);
    c_ = own;
}

void Replay::answerQuery(uint32_t request, GLuint query) {
    uint64_t value = 0;
    bool added = false;
    const auto info = bound_ ? c_->queries.find(query) : c_->queries.end();
    if (info != c_->queries.end()) {
        const std::vector<replay::QueryPiece>& pieces = info->second.pieces;
        added = countsSamples(info->second.target) &&
                std::any_of(pieces.begin(), pieces.end(), [](const replay::QueryPiece& p) { return !p.whole; });
        if (added && info->second.skipped) out_.invalid();
        for (const replay::QueryPiece& piece : pieces) {
            if (!added || (piece.whole ? config_.node == 0 : config_.answers)) value += queryResult(piece.nodeName);
        }
    } else if (bound_) {
        value = queryResult(name(Kind::Query, query));
    }
    answerBytes(request, added ? wire::ReplyKind::Sum : wire::ReplyKind::Bytes, std::as_bytes(std::span(&value, 1)));
}

// ---- conditional rendering with a known result: its query has counted something, or nothing, so that GL draws or
// skips

namespace {
bool isInverted(GLenum mode) {
    return mode == GL_QUERY_WAIT_INVERTED || mode == GL_QUERY_NO_WAIT_INVERTED ||
           mode == GL_QUERY_BY_REGION_WAIT_INVERTED || mode == GL_QUERY_BY_REGION_NO_WAIT_INVERTED;
}
} // namespace

bool Replay::onQueryKnown(Args& in) {
    const auto query = in.get<uint32_t>(), passed = in.get<uint32_t>();
    if (!in.ok()) return false;
    const auto info = c_->queries.find(query);
    if (info != c_->queries.end()) info->second.passed = passed != 0;
    return true;
}

// Executes conditional rendering of a display list. The interposer has sent the result before the call, or this node
// draws everything and has the result itself.
void Replay::glBeginConditionalRender(GLuint id, GLenum mode) {
    const auto info = c_->queries.find(id);
    if (info == c_->queries.end()) return queryDriver(name(Kind::Query, id), mode); // never begun: GL handles that case
    const std::vector<replay::QueryPiece>& pieces = info->second.pieces;
    bool passed = info->second.passed;
    if (alone() || std::all_of(pieces.begin(), pieces.end(), [](const replay::QueryPiece& p) { return p.whole; }))
        passed = std::any_of(pieces.begin(), pieces.end(),
                             [&](const replay::QueryPiece& p) { return queryResult(p.nodeName) != 0; });
    beginConditional(passed != isInverted(mode));
}

bool Replay::onDrawAll(Args&) {
    if (c_->shared && !std::exchange(c_->shared->allDrawn, true)) restoreWindowState();
    return true;
}

bool Replay::onBeginConditional(Args& in) {
    const auto draws = in.get<uint32_t>();
    if (!in.ok()) return false;
    beginConditional(draws != 0);
    return true;
}

void Replay::beginConditional(bool draws) {
    if (draws || !bound_ || !gl.glBeginConditionalRender || !gl.glGenQueries) {
        c_->isConditionTrue = true;
        return;
    }
    const bool counting = c_->counting.count(GL_SAMPLES_PASSED) > 0; // GL allows one active query per target
    if (!c_->nothingCounted) {
        if (counting) gl.glEndQuery(GL_SAMPLES_PASSED);
        gl.glGenQueries(1, &c_->nothingCounted);
        gl.glBeginQuery(GL_SAMPLES_PASSED, c_->nothingCounted);
        gl.glEndQuery(GL_SAMPLES_PASSED);
        if (counting) beginPiece(GL_SAMPLES_PASSED, c_->counting[GL_SAMPLES_PASSED]);
    }
    queryDriver(c_->nothingCounted, GL_QUERY_WAIT);
}

void Replay::queryDriver(GLuint nodeName, GLenum mode) {
    c_->conditional = bound_ && gl.glBeginConditionalRender;
    c_->condition = nodeName;
    c_->conditionMode = mode;
    if (c_->conditional) gl.glBeginConditionalRender(nodeName, mode);
}

void Replay::glEndConditionalRender() {
    if (std::exchange(c_->isConditionTrue, false)) return;
    c_->conditional = false;
    if (gl.glEndConditionalRender) gl.glEndConditionalRender();
}

} // namespace mural
