// Debug output and reset status, of the driver here and of the nodes' drivers.
#include "custom_wrappers.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/encode/real_gl.hpp"

using namespace mural;

namespace {
template <class Query> GLenum resetStatus(Query&& query) {
    ThreadState& t = *tThread;
    const GLenum here = query();
    if (!t.context) return here;
    takeDriverEvents(t);
    const GLenum there = t.context->resetStatus;
    t.context->resetStatus = GL_NO_ERROR; // reported once: the nodes' reset is complete when it is known
    return here ? here : there;
}
} // namespace

extern "C" {

void mural_glDebugMessageCallback(void* callback, const void* userParam) {
    ThreadState& t = *tThread;
    if (t.context)
        listen(*t.context, reinterpret_cast<GLDEBUGPROC>(callback), userParam);
    else
        gReal.glDebugMessageCallback(callback, userParam);
}

void mural_glGetPointerv(GLenum pname, void** params) {
    ThreadState& t = *tThread;
    gReal.glGetPointerv(pname, params);
    if (!t.context || !t.context->debug || !params) return;
    if (pname == GL_DEBUG_CALLBACK_FUNCTION) *params = reinterpret_cast<void*>(listener(*t.context));
    if (pname == GL_DEBUG_CALLBACK_USER_PARAM) *params = const_cast<void*>(listenersUser(*t.context));
}

GLenum mural_glGetGraphicsResetStatus() {
    return resetStatus([] { return gReal.glGetGraphicsResetStatus(); });
}
GLenum mural_glGetGraphicsResetStatusARB() {
    return resetStatus([] { return gReal.glGetGraphicsResetStatusARB(); });
}

} // extern "C"
