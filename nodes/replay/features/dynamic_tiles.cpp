// Dynamic tiles: this node's part of a window changes from one frame to another.
//
// A framebuffer has the whole window's size, so another part needs only another scissor. But other nodes have drawn the
// earlier content of that part, and this node lacks it. New areas are therefore applied when that content no longer
// matters: each buffer of the window has been cleared whole, with no draws since.
//
// All nodes clear the whole window. Buffers without any draws are equal on all nodes, and need no clear. Every node
// receives the same commands, and so takes the same decision. A window without full clears keeps its areas.
//
// A front buffer with a surface of its own has the areas of the frame that was swapped. Its drawn content persists.
// Windows that draw into the front, or accumulate, therefore keep their areas.
//
// An assignment also has zooms (balancer/equalizers/dfr_equalizer). Buffers that are cleared whole look equal at any
// zoom, so the same position serves both. Windows that keep their areas are drawn without zoom.
#include <algorithm>
#include <cstring>
#include <utility>

#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/window_use.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

namespace {

bool isFrontBuffer(GLenum buffer) {
    return buffer == GL_FRONT || buffer == GL_FRONT_LEFT || buffer == GL_FRONT_RIGHT || buffer == GL_FRONT_AND_BACK ||
           buffer == GL_LEFT || buffer == GL_RIGHT;
}

// Returns whether the command is a valid clear that addresses only the first colour buffer.
bool clears(uint16_t opcode, GLuint first, GLuint second) {
    using enum Trait;
    if (hasTrait(opcode, Clear)) return (first & ~kWindowBuffers) == 0;
    if (second != 0) return false;
    switch (first) {
    case GL_COLOR: return hasTrait(opcode, ClearsColor);
    case GL_DEPTH: return hasTrait(opcode, ClearsDepth);
    case GL_STENCIL: return hasTrait(opcode, ClearsStencil);
    case GL_DEPTH_STENCIL: return hasTrait(opcode, ClearsDepthStencil);
    default: return false;
    }
}

GLbitfield buffersOf(const wire::WindowConfig& config) {
    return GLbitfield{GL_COLOR_BUFFER_BIT} | (config.depth > 0 ? GL_DEPTH_BUFFER_BIT : 0) |
           (config.stencil > 0 ? GL_STENCIL_BUFFER_BIT : 0);
}

uint32_t stateOf(const replay::Window& w) {
    return (w.moving.fixed ? wire::kAreasFixed : 0) | (w.plain ? wire::kAreasPlain : 0) |
           (w.copied ? wire::kAreasPlainNext : 0);
}

} // namespace

PixelViewport Replay::partOf(const Window& w, const ViewportAssignment* areas) const {
    if (areas) {
        const auto node = static_cast<size_t>(config_.node);
        return node < areas->ofNodes.size() ? intersect(apply(w.whole, areas->ofNodes[node]), w.whole)
                                            : PixelViewport{};
    }
    return config_.area ? intersect(apply(w.whole, *config_.area), w.whole)
                        : regionViewport(config_.grid, config_.region, w.whole.w, w.whole.h);
}

void Replay::moveAreas(ViewportAssignment areas) {
    if (!moves()) return;
    areas_ = std::make_shared<const ViewportAssignment>(std::move(areas));
    for (auto& [id, client] : clients_)
        for (auto& [name, w] : client.windows) {
            if (w->moving.fixed) continue;
            if (w->moving.wanted == w->moving.areas) w->moving.waits = 0;
            w->moving.wanted = areas_;
            // planted fault: before the window's clear
            if (config_.plant == "early" && config_.node == 1) w->moving.areas = areas_;
        }
    if (config_.plant == "early" && config_.node == 1) areasChanged();
}

// Restarts the areas of a window with new buffers, whose content is equal on all nodes.
void Replay::redivide(Window& w) {
    w.moving = {};
    w.moving.areas = w.moving.wanted = w.moving.front = areas_;
}

void Replay::takeAreas(Window& w) {
    w.moving.areas = w.moving.wanted;
    w.moving.waits = 0;
    w.part = partOf(w, w.moving.areas.get());
    placePart(w);
    restoreWindowState();
}

void Replay::areasChanged() {
    for (auto& [id, client] : clients_)
        for (auto& [name, w] : client.windows) {
            w->part = partOf(*w, w->moving.areas.get());
            placePart(*w);
        }
    if (!bound_) return;
    ContextState* const own = std::exchange(c_, bound_);
    restoreWindowState();
    c_ = own;
}

// Returns the window's buffers that the command, in the current state, sets to one value everywhere.
GLbitfield Replay::clearedBy(uint16_t opcode, std::span<const std::byte> arguments) const {
    GLuint words[2] = {};
    std::memcpy(words, arguments.data(), std::min(arguments.size(), sizeof words));
    if (!clears(opcode, words[0], words[1]) || c_->inPrimitive) return 0;
    GLint mode = GL_RENDER; // GL clears nothing in selection and feedback mode
    if (c_->api == wire::Api::Desktop && !c_->core) gl.glGetIntegerv(GL_RENDER_MODE, &mode);
    return mode == GL_RENDER ? clearsWhole(clearsOf(opcode, arguments)) : 0;
}

// Returns the window's buffers that a draw may change.
GLbitfield Replay::drawnBy(uint16_t opcode) const {
    if (hasTrait(opcode, Trait::AllPlanes)) return kWindowBuffers;
    const ShareGroup& shared = *c_->shared;
    const GLbitfield known = c_->draw->moving.drawn; // avoids queries to the driver
    const auto tests = [&](GLbitfield buffer, bool ever, GLenum cap) {
        return !(known & buffer) && ever && gl.glIsEnabled(cap) ? buffer : 0;
    };
    return GLbitfield{GL_COLOR_BUFFER_BIT} | tests(GL_DEPTH_BUFFER_BIT, shared.testsDepth, GL_DEPTH_TEST) |
           tests(GL_STENCIL_BUFFER_BIT, shared.testsStencil, GL_STENCIL_TEST);
}

// Called before any command that may change pixels of the window.
void Replay::onArea(uint16_t opcode, std::span<const std::byte> arguments) {
    const WindowUse use = useOf(opcode);
    if (hasTrait(opcode, Trait::Begin, Trait::End) && !c_->compiling) c_->inPrimitive = hasTrait(opcode, Trait::Begin);
    if ((use != WindowUse::Clears && use != WindowUse::Draws) || !c_->shared) return;
    if (c_->compiling) {
        // lists may change depth and stencil
        if (use == WindowUse::Clears || hasTrait(opcode, Trait::AllPlanes))
            c_->shared->testsDepth = c_->shared->testsStencil = true;
        if (c_->compileMode == GL_COMPILE_AND_EXECUTE) onNativeList(); // the driver draws it during compilation
        return;
    }
    // the items of lists are noted one by one
    if (!drawsWindow() || !c_->draw || hasTrait(opcode, Trait::CallList)) return;
    Window& w = *c_->draw;
    replay::MovingPart& m = w.moving;
    const GLbitfield cleared = use == WindowUse::Clears ? clearsOf(opcode, arguments) : 0;
    const bool stays = hasTrait(opcode, Trait::Accumulates) || (cleared & GL_ACCUM_BUFFER_BIT) ||
                       (w.config.doubleBuffer && isFrontBuffer(c_->drawBuffer0)) || w.config.stereo;
    if (stays && !m.fixed) {
        m.fixed = true;
        m.wanted = m.areas;
    }
    // All clears, including partial ones, run without the tile (withoutTile), so buffers that are equal on all nodes
    // stay so. With a zoom that changes, a partial clear counts as a draw, because its place depends on the zoom.
    if (use == WindowUse::Clears && ((m.drawn & cleared) || config_.anyMovesZoom)) {
        const GLbitfield whole = clearedBy(opcode, arguments);
        m.drawn &= ~whole;
        if (config_.anyMovesZoom) m.drawn |= cleared & ~whole & buffersOf(w.config);
    }
    if (m.wanted != m.areas && (m.drawn == 0 || config_.plant == "uncleared")) takeAreas(w);
    if (use == WindowUse::Draws) m.drawn |= drawnBy(opcode) & buffersOf(w.config);
}

// Called before a native list, whose draws and enables are unknown. It counts as a draw of colours, and of depth and
// stencil if any command or list has enabled their tests.
void Replay::onNativeList() {
    if (!drawsWindow() || !c_->draw || !c_->shared) return;
    Window& w = *c_->draw;
    if (w.moving.wanted != w.moving.areas && w.moving.drawn == 0 && !c_->compiling) takeAreas(w);
    const GLbitfield tested =
        (c_->shared->testsDepth ? GL_DEPTH_BUFFER_BIT : 0) | (c_->shared->testsStencil ? GL_STENCIL_BUFFER_BIT : 0);
    w.moving.drawn |= (GL_COLOR_BUFFER_BIT | tested) & buffersOf(w.config);
    if (w.config.doubleBuffer && isFrontBuffer(c_->drawBuffer0) && !std::exchange(w.moving.fixed, true))
        w.moving.wanted = w.moving.areas;
}

void Replay::onTests(GLenum cap) {
    if (!c_->shared) return;
    if (cap == GL_DEPTH_TEST) c_->shared->testsDepth = true;
    if (cap == GL_STENCIL_TEST) c_->shared->testsStencil = true;
}

// ---- returned nodes: their snapshot contains no areas. Until they receive them, they draw every window whole.

std::vector<std::byte> Replay::memberAreas() const {
    std::vector<std::shared_ptr<const ViewportAssignment>> named{areas_};
    std::vector<wire::WindowAreas> windows;
    for (const auto& [client, its] : clients_)
        for (const auto& [id, w] : its.windows) {
            const replay::MovingPart& m = w->moving;
            if (!m.areas) continue;
            windows.push_back({client, id, m.areas->number, m.wanted->number, m.front->number, m.drawn, stateOf(*w)});
            for (const auto& areas : {m.areas, m.wanted, m.front})
                if (std::ranges::find(named, areas) == named.end()) named.push_back(areas);
        }
    const auto count = static_cast<uint32_t>(windows.size());
    std::vector<std::byte> bytes(sizeof count + count * sizeof(wire::WindowAreas));
    std::memcpy(bytes.data(), &count, sizeof count);
    if (count > 0) std::memcpy(bytes.data() + sizeof count, windows.data(), count * sizeof(wire::WindowAreas));
    for (const auto& areas : named) {
        const auto more = bytesOf(*areas);
        bytes.insert(bytes.end(), more.begin(), more.end());
    }
    return bytes;
}

bool Replay::takeMemberAreas(std::span<const std::byte> bytes) {
    uint32_t count = 0;
    if (!moves() || bytes.size() < sizeof count) return false;
    std::memcpy(&count, bytes.data(), sizeof count);
    bytes = bytes.subspan(sizeof count);
    if (bytes.size() / sizeof(wire::WindowAreas) < count) return false;
    std::vector<wire::WindowAreas> windows(count);
    if (count > 0) std::memcpy(windows.data(), bytes.data(), count * sizeof(wire::WindowAreas));
    bytes = bytes.subspan(count * sizeof(wire::WindowAreas));
    std::map<uint32_t, std::shared_ptr<const ViewportAssignment>> named;
    while (!bytes.empty()) {
        auto areas = mural::takeAreas(bytes);
        if (!areas) return false;
        auto shared = std::make_shared<const ViewportAssignment>(std::move(*areas));
        if (named.empty()) areas_ = shared;
        named.emplace(shared->number, shared);
    }
    for (const wire::WindowAreas& member : windows) {
        const auto client = clients_.find(member.client);
        if (client == clients_.end() || !client->second.windows.contains(member.window)) continue;
        if (!named.contains(member.areas) || !named.contains(member.wanted) || !named.contains(member.front))
            return false;
        replay::MovingPart& m = client->second.windows[member.window]->moving;
        m.areas = named[member.areas];
        m.wanted = named[member.wanted];
        m.front = named[member.front];
        m.drawn = member.drawn;
        m.fixed = (member.state & wire::kAreasFixed) != 0;
        if (!config_.anyMovesZoom) continue;
        Window& w = *client->second.windows[member.window];
        w.plain = (member.state & wire::kAreasPlain) != 0;
        w.copied = (member.state & wire::kAreasPlainNext) != 0;
    }
    knowsAreas_ = true;
    areasChanged();
    return true;
}

void Replay::beginAreas() {
    if (!moves()) return;
    for (auto& [id, client] : clients_)
        for (auto& [name, w] : client.windows) w->moving.areas = w->moving.wanted = w->moving.front = areas_;
    knowsAreas_ = true;
    areasChanged();
}

} // namespace mural
