#include "interposer/x11/shown.hpp"

#include "encoders.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

void waitWindowsShown() {
    if (Session* s = Session::current()) s->waitShown();
}

void waitGlShown() {
    Session* s = Session::current();
    if (!s || !s->alive()) return;
    if (tThread->context) encode_glFlush(*tThread); // nodes do not flush when they switch contexts
    flushedWindow(*tThread);
    s->waitShown();
}

} // namespace mural
