#include "interposer/context/window_size.hpp"

#include "interposer/context/context.hpp"
#include "interposer/entry/own_functions.hpp"
#include "interposer/x11/server_grabs.hpp"

namespace mural {

bool queryWindowSize(const Window& w, uint32_t& width, uint32_t& height) {
    if (querySizeDuringGrab(w, width, height)) return true;
    return w.isEgl ? queryEglSize(w, width, height) : queryGlxSize(w, width, height);
}

void beforeAwaitedReading(ThreadState& t) {
    if (!t.drawingAwaited || !t.context || !t.context->isMesa) return;
    for (const uint32_t id : {t.context->drawWindow, t.context->readWindow}) {
        Window* const w = id ? findWindowById(id) : nullptr;
        if (w && !w->sizeKnown) updateWindowSize(t, *w);
    }
}

} // namespace mural
