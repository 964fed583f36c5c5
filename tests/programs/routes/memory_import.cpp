// Memory objects (EXT_memory_object): no memory can be imported, and the queries report this in advance.
#include <algorithm>
#include <cstdio>
#include <sys/mman.h>
#include <unistd.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"

using namespace programs;

namespace {

constexpr GLsizei kBytes = 4096;

bool sameUuid(const GLubyte* a, const GLubyte* b) { return std::equal(a, a + GL_UUID_SIZE_EXT, b); }

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {Profile::Core, 4, 5}, [](Window&) {},
        [](Window&, int frame) {
            if (frame > 0) {
                return;
            }
            GLubyte driver[GL_UUID_SIZE_EXT] = {};
            GLubyte device[GL_UUID_SIZE_EXT] = {};
            glGetUnsignedBytevEXT(GL_DRIVER_UUID_EXT, driver);
            glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, 0, device);
            checkNoError("after the UUIDs");
            GLuint memory = 0;
            GLuint buffer = 0;
            glCreateMemoryObjectsEXT(1, &memory);
            glCreateBuffers(1, &buffer);
            checkNoError("with a memory object");
            const int descriptor = memfd_create("memory", MFD_CLOEXEC);
            if (descriptor < 0 || ftruncate(descriptor, kBytes) != 0) {
                fail("no memory to import");
            }
            glImportMemoryFdEXT(memory, kBytes, GL_HANDLE_TYPE_OPAQUE_FD_EXT, descriptor);
            const GLenum refused = glGetError();
            const bool left = ftruncate(descriptor, kBytes) == 0;
            glNamedBufferStorageMemEXT(buffer, kBytes, memory, 0);
            std::printf("object %d, one UUID %d, import 0x%04x, descriptor left %d, storage 0x%04x\n",
                        glIsMemoryObjectEXT(memory), sameUuid(driver, device), refused, left, glGetError());
            glDeleteMemoryObjectsEXT(1, &memory);
        });
}
