// Memory shared with other APIs (EXT_memory_object) is unavailable to the nodes. Programs see device and driver UUIDs
// that match no Vulkan device; the extension requires them to compare before they share. An import without that check
// fails.
#include <cstring>

#include "custom_wrappers.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"

using namespace mural;

namespace {

constexpr GLubyte kUuid[GL_UUID_SIZE_EXT] = {0xb9, 0x1f, 0x6c, 0x4e, 0x72, 0x0a, 0x4d, 0x35,
                                             0x8e, 0xc3, 0x1d, 0x58, 0xa7, 0x60, 0xf2, 0x94};

template <class Call> void getBytes(GLenum pname, GLubyte* data, Call&& call) {
    const ThreadState& t = *tThread;
    if (!capturing(t)) return call();
    const bool isUuid = pname == GL_DEVICE_UUID_EXT || pname == GL_DRIVER_UUID_EXT;
    if (raisesNothing(*t.context, call) && isUuid && data) std::memcpy(data, kUuid, sizeof kUuid);
}

} // namespace

extern "C" {

void mural_glGetUnsignedBytevEXT(GLenum pname, GLubyte* data) {
    getBytes(pname, data, [&] { gReal.glGetUnsignedBytevEXT(pname, data); });
}
void mural_glGetUnsignedBytei_vEXT(GLenum target, GLuint index, GLubyte* data) {
    getBytes(target, data, [&] { gReal.glGetUnsignedBytei_vEXT(target, index, data); });
}

// The program keeps ownership of the descriptor, as after every failed import.
void mural_glImportMemoryFdEXT(GLuint memory, GLuint64 size, GLenum handleType, GLint fd) {
    const ThreadState& t = *tThread;
    if (!capturing(t) || handleType != GL_HANDLE_TYPE_OPAQUE_FD_EXT)
        return gReal.glImportMemoryFdEXT(memory, size, handleType, fd);
    static bool once = false;
    if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED))
        say("memory of other APIs (glImportMemoryFdEXT) is not supported on the wall: the program receives an error");
    stashError(*t.context, driverError());
    stashError(*t.context, GL_INVALID_OPERATION);
}

} // extern "C"
