// Frees contexts and windows that the program has destroyed. As in GLX, a current one lives until it is released. A
// share group keeps its objects as long as one of its contexts lives.
#include <algorithm>
#include <vector>

#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

bool Replay::onDestroyContext(Args& in) {
    const auto id = in.get<uint32_t>();
    if (!in.ok()) return false;
    Client& client = clients_[wire::clientOf(stream_)];
    const auto it = client.contexts.find(id);
    if (it == client.contexts.end()) return true;
    it->second->destroyed = true;
    client.anyDestroyed = true;
    freeDestroyed(client);
    return true;
}

bool Replay::onDestroyWindow(Args& in) {
    const auto id = in.get<uint32_t>();
    if (!in.ok()) return false;
    Client& client = clients_[wire::clientOf(stream_)];
    const auto it = client.windows.find(id);
    if (it == client.windows.end()) return true;
    it->second->destroyed = true;
    client.anyDestroyed = true;
    freeDestroyed(client);
    if (out_.windowGone) out_.windowGone(wire::clientOf(stream_), id);
    return true;
}

// Releases the platform's current context and surfaces. No stream may have them current any more, because streams are
// bound only when their packets arrive.
void Replay::unbindPlatform() {
    (void)platform_->makeCurrent(nullptr, nullptr, nullptr);
    bound_ = nullptr;
    boundDraw_ = boundRead_ = nullptr;
}

void Replay::freeDestroyed(Client& client) {
    if (!client.anyDestroyed) return;
    const auto streamHas = [&](auto&& has) {
        return std::any_of(client.streams.begin(), client.streams.end(),
                           [&](const auto& s) { return s.second.context && has(s.second); });
    };
    bool left = false;
    for (auto it = client.contexts.begin(); it != client.contexts.end();) {
        ContextState* const c = it->second.get();
        const bool used = c->destroyed && streamHas([&](const Stream& s) { return s.context == c; });
        left = left || used;
        if (!c->destroyed || used) {
            ++it;
            continue;
        }
        if (bound_ == c) unbindPlatform();
        if (c_ == c) c_ = none_.get();
        for (auto& [id, w] : client.windows)
            if (w->drawer == c) w->drawer = nullptr;
        it = client.contexts.erase(it);
    }
    for (auto it = client.windows.begin(); it != client.windows.end();) {
        Window* const w = it->second.get();
        const bool used = w->destroyed && streamHas([&](const Stream& s) { return s.draw == w || s.read == w; });
        left = left || used;
        if (!w->destroyed || used) {
            ++it;
            continue;
        }
        if (boundDraw_ == w || boundRead_ == w) unbindPlatform();
        std::vector<gl::Context*> users;
        for (auto& [id, c] : client.contexts) {
            if (c->draw == w || c->read == w) users.push_back(c->context.get());
            if (c->draw == w) c->draw = nullptr;
            if (c->read == w) c->read = nullptr;
        }
        for (auto& [id, s] : client.streams) {
            if (s.draw == w) s.draw = nullptr;
            if (s.read == w) s.read = nullptr;
        }
        it = client.windows.erase(it);
        // Mesa's contexts keep the buffers of a destroyed surface until their next binding.
        for (gl::Context* const c : users) (void)platform_->makeCurrent(c, nullptr, nullptr);
        if (!users.empty()) unbindPlatform();
    }
    client.anyDestroyed = left;
    // Restores the binding of the stream that is being replayed.
    if (!bound_ && s_ && s_->context) bindStream(*s_);
}

} // namespace mural
