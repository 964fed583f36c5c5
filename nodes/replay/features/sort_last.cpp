// Sort-last: the nodes of one picture share its opaque draws. Each node draws a contiguous range of them, in order. The
// collector then composites the pictures by depth, and draws the rest alone.
//
//   Fresh    All nodes execute the clears of the frame.
//   Split    Each node draws its range of the depth-tested, opaque draws. For other ranges it closes the scissor, or
//            draws no vertices.
//   Whole    The collector has the whole picture and draws the rest of the frame. This phase begins with a read of the
//            picture, or with the first draw that depends on earlier pixels (blending, stencil, no depth test, …).
//
// The stream and the state alone determine the shared draws, and the previous frame's cost determines the ranges. All
// nodes therefore agree without messages. A returned node has no costs, so all nodes begin anew with it, at one
// position of the stream.
//
// The composition applies the depth test to the draws in their order, so the picture equals a single machine's, bit for
// bit (docs/architecture/sort-last.md). All nodes draw framebuffer objects. nodes/exchange composites the pictures.
#include <algorithm>
#include <cstring>
#include <utility>

#include "nodes/replay/engine/command_uses.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

namespace {

uint32_t wordAt(std::span<const std::byte> bytes, size_t index) {
    uint32_t word = 0;
    if (bytes.size() >= 4 * (index + 1)) std::memcpy(&word, bytes.data() + 4 * index, 4);
    return word;
}
void setWord(std::vector<std::byte>& bytes, size_t index, uint32_t word) {
    std::memcpy(bytes.data() + 4 * index, &word, 4);
}

// Vertices of an independent primitive; 0: primitives share vertices.
uint32_t verticesOf(uint32_t mode) {
    switch (mode) {
    case GL_POINTS: return 1;
    case GL_LINES: return 2;
    case GL_TRIANGLES: return 3;
    case GL_QUADS: return 4;
    default: return 0;
    }
}

uint32_t indexBytes(uint32_t type) { return type == GL_UNSIGNED_INT ? 4 : type == GL_UNSIGNED_SHORT ? 2 : 1; }

constexpr uint64_t kUnknownCost = 64; // of draws with an unknown number of vertices

} // namespace

// ---- state

bool Replay::mayShare() {
    if (c_->rangeKnown) return c_->mayShare;
    c_->rangeKnown = true;
    c_->mayShare = false;
    const auto on = [&](GLenum cap) { return gl.glIsEnabled(cap) != GL_FALSE; };
    if (c_->api != wire::Api::Desktop || !c_->draw || c_->read != c_->draw || c_->draw->config.samples > 0 ||
        c_->draw->config.depth == 0)
        return false;
    if (c_->draw->programRed > 8) return false; // the exchange has 8 bits per channel
    if (!on(GL_DEPTH_TEST) || on(GL_BLEND) || on(GL_STENCIL_TEST) || on(GL_COLOR_LOGIC_OP)) return false;
    if (!c_->core && on(GL_INDEX_LOGIC_OP)) return false;
    GLboolean depthMask = GL_FALSE;
    gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask);
    GLint function = 0;
    gl.glGetIntegerv(GL_DEPTH_FUNC, &function);
    if (!depthMask || (function != GL_LESS && function != GL_LEQUAL && function != GL_GREATER && function != GL_GEQUAL))
        return false;
    for (const auto& mask : c_->colorMasks.buffers)
        if (!mask[0] || !mask[1] || !mask[2] || !mask[3]) return false;
    if (c_->drawBuffer0 != GL_BACK && c_->drawBuffer0 != GL_BACK_LEFT) return false;
    c_->mayShare = true;
    return true;
}

void Replay::onRangeState(uint16_t opcode, std::span<const std::byte> arguments) {
    c_->rangeKnown = false;
    switch (rangeUseOf(opcode)) {
    case RangeUse::Memory: {
        const uint32_t target = wordAt(arguments, 0);
        if (hasTrait(opcode, Trait::ImageBinding) || target == GL_SHADER_STORAGE_BUFFER ||
            target == GL_ATOMIC_COUNTER_BUFFER)
            c_->writesMemory = true;
        break;
    }
    case RangeUse::Feedback:
        if (!hasTrait(opcode, Trait::FeedbackDraw)) c_->rangeFeedsBack = hasTrait(opcode, Trait::FeedbackBegin);
        break;
    case RangeUse::Query:
        c_->activeQueries = std::max(0, c_->activeQueries + (hasTrait(opcode, Trait::QueryBegin) ? 1 : -1));
        break;
    default: break;
    }
}

void Replay::recordPrimitiveIds(GLuint nodeName) {
    GLuint attached[64] = {};
    GLsizei count = 0;
    gl.glGetAttachedShaders(nodeName, 64, &count, attached);
    bool numbers = count == 0;
    for (GLsizei i = 0; i < count; ++i) {
        GLint length = 0;
        gl.glGetShaderiv(attached[i], GL_SHADER_SOURCE_LENGTH, &length);
        std::string text(static_cast<size_t>(std::max(length, 1)), '\0');
        gl.glGetShaderSource(attached[i], static_cast<GLsizei>(text.size()), nullptr, text.data());
        numbers = numbers || length <= 1 || text.find("gl_PrimitiveID") != std::string::npos;
    }
    if (c_->shared) c_->shared->primitiveIds[nodeName] = numbers;
}

// Records the content of a native list during its compilation.
void Replay::onCompiled(uint16_t opcode, std::span<const std::byte> arguments) {
    if (c_->building.items.empty()) return;
    DisplayListItem& item = c_->building.items.back();
    switch (rangeUseOf(opcode)) {
    case RangeUse::Vertex: ++item.vertices; break;
    case RangeUse::Draw: {
        const size_t count = effectOf(opcode).draw.count;
        item.vertices +=
            std::max<uint32_t>(1, count > 0 ? wordAt(arguments, count) : static_cast<uint32_t>(kUnknownCost));
        break;
    }
    case RangeUse::None:
    case RangeUse::Begin:
    case RangeUse::End: break;
    default: item.plain = false;
    }
}

// ---- the frame

void Replay::mute(Window& w, bool muted) {
    if (w.range.muted == muted) return;
    w.range.muted = muted;
    placePart(w);
    if (&w == boundDraw_) applyScissors();
}

void Replay::beginSplit(Window& w) {
    RangeFrame& r = w.range;
    GLint function = 0;
    gl.glGetIntegerv(GL_DEPTH_FUNC, &function);
    r.function = static_cast<GLenum>(function);
    r.phase = RangeFrame::Phase::Split;
    r.wasSplit = r.wasSplit || r.lastTotal > 0;
    const PixelViewport drawn = partDrawn(w);
    if (r.lastTotal == 0) return;
    r.share = share_;
    r.shares = sharesNumber_;
    if (drawn.empty()) return;
    PicturePart pixel; // with the values of the clears
    readPart(w, {drawn.x, drawn.y, 1, 1}, pixel);
    r.rule.clearedColour = pixel.colour[0];
    r.rule.clearedDepth = pixel.depth[0];
    r.rule.function = static_cast<compositor::DepthFunction>(r.function - GL_NEVER); // in GL's numbering
    r.rule.deep = depthBitsOfWindow() > 24;
}

// Returns the depth bits of the bound window, possibly more than the program requested.
int Replay::depthBitsOfWindow() {
    GLint bits = 0;
    if (!c_->core)
        gl.glGetIntegerv(GL_DEPTH_BITS, &bits);
    else
        gl.glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE,
                                                 &bits);
    return bits > 0 ? bits : 32;
}

// Returns whether the window's next draws, of `cost`, are shared. This node's part of them then is [first, last).
bool Replay::shares(Window& w, uint64_t cost, uint64_t& first, uint64_t& last) {
    RangeFrame& r = w.range;
    if (r.phase == RangeFrame::Phase::Whole) return false;
    constexpr GLbitfield kNeeded = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT;
    const bool may = mayShare() && !allDrawn() && !c_->writesMemory && !c_->rangeFeedsBack && c_->activeQueries == 0 &&
                     (r.cleared & kNeeded) == kNeeded;
    GLint function = 0;
    if (may && r.phase == RangeFrame::Phase::Split) gl.glGetIntegerv(GL_DEPTH_FUNC, &function);
    if (!may || (function != 0 && static_cast<GLenum>(function) != r.function)) {
        drawRest(w);
        return false;
    }
    if (r.phase == RangeFrame::Phase::Fresh) beginSplit(w);
    // In the first frame no cost is known, so the collector draws all. In later frames the last node draws any excess
    // over the previous frame's cost.
    const auto costAt = [&](double share) { return share >= 1 ? UINT64_MAX : countBefore(share, r.lastTotal); };
    const uint64_t from = r.lastTotal ? costAt(r.share.start) : collects() ? 0 : UINT64_MAX;
    const uint64_t to = r.lastTotal ? costAt(r.share.end) : UINT64_MAX;
    const uint64_t at = r.cost;
    r.cost += cost;
    first = std::clamp(from, at, at + cost) - at;
    last = std::clamp(to, at, at + cost) - at;
    return true;
}

// Composites the picture. The collector draws the rest of the frame.
void Replay::drawRest(Window& w) {
    if (w.range.phase == RangeFrame::Phase::Whole) return;
    composeRanges(w);
    w.range.phase = RangeFrame::Phase::Whole;
    mute(w, !collects());
}

std::span<const std::byte> Replay::onRangeDraw(Window& w, uint16_t opcode, std::span<const std::byte> arguments) {
    const DrawWords& c = effectOf(opcode).draw;
    const uint32_t count = wordAt(arguments, c.count), each = verticesOf(wordAt(arguments, 0));
    const uint64_t instances = c.instances > 0 ? wordAt(arguments, c.instances) : 1;
    const uint64_t cost =
        c.count > 0
            ? std::max<uint64_t>(1, std::min<uint64_t>(count, INT32_MAX) * std::min<uint64_t>(instances, 1u << 20))
            : kUnknownCost;
    uint64_t first = 0, last = 0;
    if (!shares(w, cost, first, last)) return arguments;
    const auto numbers = c_->shared->primitiveIds.find(name(Kind::Program, c_->program));
    bool cuts = c.count > 0 && each > 0 && count <= INT32_MAX && instances == 1 && !c_->pipelineBound &&
                !stipplesLines() &&
                (c_->program == 0 || (numbers != c_->shared->primitiveIds.end() && !numbers->second));
    if (cuts && c.indices > 0)
        cuts = wordAt(arguments, c.indices) == record::kTagOffset && !gl.glIsEnabled(GL_PRIMITIVE_RESTART) &&
               (c_->version < 43 || !gl.glIsEnabled(GL_PRIMITIVE_RESTART_FIXED_INDEX));
    if (!cuts) { // the node whose range contains its first vertex draws it whole
        mute(w, first != 0 || last == 0);
        return arguments;
    }
    const auto edge = [&](uint64_t at) {
        return static_cast<uint32_t>(at >= cost ? count : (at + each - 1) / each * each);
    };
    const uint32_t from = std::min(edge(first), count), to = std::min(edge(last), count);
    mute(w, false);
    if (from == 0 && to == count) return arguments;
    sliced_.assign(arguments.begin(), arguments.end());
    setWord(sliced_, c.count, to > from ? to - from : 0);
    if (c.first > 0) setWord(sliced_, c.first, wordAt(arguments, c.first) + from);
    const size_t indices = c.indices; // a value: tag, u64 offset
    if (indices > 0 && arguments.size() >= 4 * (indices + 3)) {
        uint64_t offset = 0;
        std::memcpy(&offset, arguments.data() + 4 * (indices + 1), 8);
        offset += uint64_t{from} * indexBytes(wordAt(arguments, c.type));
        std::memcpy(sliced_.data() + 4 * (indices + 1), &offset, 8);
    }
    return sliced_;
}

// Called before any command. Returns the arguments for its execution.
std::span<const std::byte> Replay::onRange(uint16_t opcode, std::span<const std::byte> arguments) {
    const RangeUse use = rangeUseOf(opcode);
    if (use == RangeUse::None || !bound_ || c_->compiling) return arguments;
    if (use == RangeUse::State || use == RangeUse::Memory || use == RangeUse::Query || use == RangeUse::Feedback) {
        onRangeState(opcode, arguments);
        if (use != RangeUse::Feedback) return arguments;
    }
    // The command may read the window too.
    if (use == RangeUse::Read && c_->readFramebuffer == 0 && c_->read && c_->read == c_->draw) drawRest(*c_->read);
    if (!drawsWindow() || !c_->draw) return arguments;
    Window& w = *c_->draw;
    uint64_t first = 0, last = 0;
    switch (use) {
    case RangeUse::Clear: {
        const uint32_t mask = wordAt(arguments, 0);
        if (w.range.phase == RangeFrame::Phase::Fresh)
            w.range.cleared |= clearsWhole(mask);
        else
            drawRest(w);
        return arguments;
    }
    case RangeUse::Read:
    case RangeUse::Feedback: drawRest(w); return arguments;
    case RangeUse::Begin:
        c_->inPrimitive = true;
        if (shares(w, 1, first, last)) mute(w, first != 0 || last == 0);
        return arguments;
    case RangeUse::End: c_->inPrimitive = false; return arguments;
    case RangeUse::Vertex:
        if (w.range.phase == RangeFrame::Phase::Split) ++w.range.cost;
        return arguments;
    case RangeUse::Draw: return onRangeDraw(w, opcode, arguments);
    default: return arguments;
    }
}

// Treats a native list as one draw, because its draws cannot be divided. Returns false if the list changes state on
// which the division of later draws depends.
bool Replay::onRangeList(const DisplayListItem& item) {
    if (!bound_ || !drawsWindow() || !c_->draw || c_->inPrimitive) return item.plain;
    Window& w = *c_->draw;
    if (!item.plain) {
        drawRest(w);
        return false;
    }
    uint64_t first = 0, last = 0;
    if (item.vertices > 0 && shares(w, item.vertices, first, last)) mute(w, first != 0 || last == 0);
    return true;
}

// ---- pictures

void Replay::readPart(Window& w, const PixelViewport& box, PicturePart& part) {
    const GLuint bound = c_->readFramebuffer;
    if (bound && gl.glBindFramebuffer) gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    c_->readFramebuffer = 0;
    gl.glReadBuffer(windowBuffer(c_->drawBuffer0, &w));
    depthForReading();
    const auto pixels = static_cast<size_t>(box.area());
    part.id = {wire::clientOf(stream_), w.range.serial, box};
    part.colour.resize(pixels);
    part.depth.resize(pixels);
    withQueriesSuspended([&] {
        withPlainTransfer([&] {
            std::memcpy(part.colour.data(), readRegion(box, GL_RGBA, GL_UNSIGNED_BYTE, pixels * 4), pixels * 4);
            std::memcpy(part.depth.data(), readRegion(box, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, pixels * 4),
                        pixels * 4);
        });
    });
    gl.glReadBuffer(windowBuffer(c_->readBuffer0, &w));
    c_->readFramebuffer = bound;
    if (bound && gl.glBindFramebuffer) gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, name(Kind::Framebuffer, bound));
}

// Writes `area` of the part, in its own pixels, into the bound window.
void Replay::writePart(const PicturePart& part, const PixelViewport& area) {
    std::vector<uint32_t> colour, depth;
    for (int32_t y = 0; y < area.h; ++y) {
        const auto from = static_cast<ptrdiff_t>(part.at(area.x, area.y + y));
        colour.insert(colour.end(), part.colour.begin() + from, part.colour.begin() + from + area.w);
        depth.insert(depth.end(), part.depth.begin() + from, part.depth.begin() + from + area.w);
    }
    const PixelViewport inWindow{part.id.box.x + area.x, part.id.box.y + area.y, area.w, area.h};
    const GLenum reads = std::exchange(c_->readBuffer0, c_->drawBuffer0);
    withQueriesSuspended([&] {
        fillColor(inWindow, colour.data());
        fillByOtherContext(inWindow, GL_DEPTH_BUFFER_BIT, depth.data());
    });
    c_->readBuffer0 = reads;
    if (c_->readFramebuffer == 0) gl.glReadBuffer(windowBuffer(reads, c_->read));
}

void Replay::composeRanges(Window& w) {
    RangeFrame& r = w.range;
    if (r.phase != RangeFrame::Phase::Split || &w != boundDraw_) return;
    r.phase = RangeFrame::Phase::Whole;
    mute(w, false);
    const PixelViewport drawn = partDrawn(w);
    if (r.lastTotal == 0 || drawn.empty() || !hasTurn(w.turn)) return; // the collector or another node drew everything
    for (; returnsTaken_ < r.returns; ++returnsTaken_) {
        returns_.front()();
        returns_.pop_front();
    }
    if (returnsTaken_ > r.returns) return; // the other nodes have continued with later pictures
    PicturePart part;
    ++r.serial;
    readPart(w, drawn, part);
    if (!out_.composeParts) return;
    const PixelViewport changed = out_.composeParts(part, r.rule, {});
    if (collects() && !changed.empty()) writePart(part, changed);
}

// Called before the bound window is read or unbound.
void Replay::composeBound() {
    if (!bound_ || !boundDraw_) return;
    ContextState* const own = std::exchange(c_, bound_);
    if (drawsWindow() && boundDraw_->range.phase == RangeFrame::Phase::Split && !c_->compiling) drawRest(*boundDraw_);
    c_ = own;
}

void Replay::rangeDrawn(Window& w) {
    RangeFrame& r = w.range;
    ContextState* const own = std::exchange(c_, bound_ ? bound_ : c_);
    if (&w == boundDraw_ && bound_) {
        const GLuint framebuffer = c_->drawFramebuffer;
        if (framebuffer != 0 && gl.glBindFramebuffer) glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        composeRanges(w);
        mute(w, false);
        if (framebuffer != 0 && gl.glBindFramebuffer) glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    }
    c_ = own;
    const uint64_t total = r.cost, serial = r.serial;
    const uint32_t drawnBy = r.shares;
    const bool split = r.wasSplit, knows = knowsCosts_ && r.returns == returnsSeen();
    r = {};
    r.wasSplit = split;
    r.drawnBy = drawnBy;
    r.returns = returnsSeen();
    if (!knows) return; // as after the first frame
    r.lastTotal = total;
    r.serial = serial;
}

// The planted fault "lateshare" applies the previously announced shares.
void Replay::moveShares(const RangeAssignment& shares) {
    const auto node = static_cast<size_t>(config_.node);
    if (!takesRanges() || node >= shares.ofNodes.size()) return;
    const bool late = config_.plant == "lateshare" && config_.node == 1;
    share_ = late ? std::exchange(plantedShare_, shares.ofNodes[node]) : shares.ofNodes[node];
    sharesNumber_ = shares.number;
}

// The returned node may have received only a part of the current frame's draws, and of their cost. The current frame is
// therefore composited without it. All nodes treat the next frame of each window as its first, and count its cost. A
// frame whose sharing has begun ends with the same nodes and shares.
void Replay::resetShares(bool itself, std::function<void()> returned) {
    if (!takesRanges()) return;
    share_ = config_.pass.share; // new shares follow
    sharesNumber_ = 0;
    knowsCosts_ = knowsCosts_ || itself;
    for (auto& [client, its] : clients_)
        for (auto& [id, w] : its.windows) {
            RangeFrame& r = w->range;
            const bool shared = r.phase == RangeFrame::Phase::Split && r.lastTotal > 0;
            if (!shared) r.lastTotal = 0;
        }
    returns_.push_back(std::move(returned));
}

} // namespace mural
