#include "interposer/x11/shown.hpp"

#include "encoders.hpp"
#include "interposer/context/context.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

void waitWindowsShown() {
    if (Session* s = Session::current()) s->waitShown();
}

void waitBeforeRead() {
    if (Session* s = Session::current()) {
        s->hideOverlay();
        s->waitShown();
    }
}

void waitBeforeCopy(unsigned long drawable) { known::hasWindow(drawable) ? waitBeforeRead() : waitWindowsShown(); }

void waitGlShown() {
    Session* s = Session::current();
    if (!s || !s->alive()) return;
    if (tThread->context) encode_glFlush(*tThread); // nodes do not flush when they switch contexts
    flushedWindow(*tThread);
    s->waitShown();
}

} // namespace mural
