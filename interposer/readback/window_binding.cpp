#include "interposer/readback/window_binding.hpp"

#include "interposer/context/context.hpp"
#include "interposer/entry/own_functions.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

// Returns whether the driver accepts the pair. GLX answers a mismatch with an X error, which ends most programs.
bool goTogether(const Context& c, const Window& w) {
    const wire::WindowConfig &a = c.config, &b = w.config;
    return a.red == b.red && a.green == b.green && a.blue == b.blue && a.alpha == b.alpha && a.depth == b.depth &&
           a.stencil == b.stencil && a.samples == b.samples && !a.doubleBuffer == !b.doubleBuffer &&
           a.accum == b.accum && a.stereo == b.stereo && a.srgb == b.srgb;
}

// Returns whether the window keeps its buffers after the context is bound to another one. GLX frees the buffers of a
// plain X window with the last context that was bound to it.
bool keepsBuffers(const Window* w, const Context& c) {
    if (!w || w->isEgl || w->drawable != w->native) return true;
    return w->holders > (c.retained[0] == w) + (c.retained[1] == w);
}

} // namespace

WindowBinding::WindowBinding(ThreadState& t, Window& w) : t_(t), before_(*t.context) {
    ready_ = before_.drawWindow == w.id && before_.readWindow == w.id;
    if (ready_ || !w.drawable) return;
    Context* const by = contextFor(w);
    ready_ = by && bind(*by, &w, &w);
}

// Returns the thread's own context, or one that is current nowhere and was bound to this window last.
Context* WindowBinding::contextFor(const Window& w) const {
    if (!before_.drawWindow || !before_.readWindow) return nullptr; // its previous state could not be restored
    const bool leaves = keepsBuffers(findWindowById(before_.drawWindow), before_) &&
                        keepsBuffers(findWindowById(before_.readWindow), before_);
    if (before_.drawWindow == w.id) return leaves ? &before_ : nullptr;
    if (Context* const idle = known::idleContextOf(w)) return idle;
    return leaves && !w.isEgl && goTogether(before_, w) ? &before_ : nullptr;
}

WindowBinding::~WindowBinding() {
    if (bound_) (void)bind(before_, findWindowById(before_.drawWindow), findWindowById(before_.readWindow));
}

bool WindowBinding::bind(Context& context, const Window* draw, const Window* read) {
    if (!draw || !read) return false;
    if (!(draw->isEgl ? makeEglCurrent(*draw, *read, context) : makeGlxCurrent(*draw, *read, context))) return false;
    bound_ = true;
    t_.context = &context;
    records::makeCurrent(t_, context.id, draw->id, read->id);
    return true;
}

} // namespace mural
