// Buffers that the program has mapped: what it writes into them goes to the nodes, and what the nodes
// have written into them comes back. Mapping itself is the program's own context's.
#pragma once

#include <GL/gl.h>
#include <cstdint>

namespace mural {

struct ShareGroup;
struct ThreadState;

// The program has mapped these bytes of the buffer at `memory`, with the access bits of glMapBufferRange.
void mapBegins(ThreadState& t, GLuint buffer, void* memory, uint64_t offset, uint64_t length, GLbitfield access);
// The buffer is the program's own memory from now on (AMD_pinned_memory): both sides write it at any time.
void pinBegins(ThreadState& t, GLuint buffer, void* memory, uint64_t length);
// Before it ends, by unmap, new storage or deletion; `ship` says whether its bytes still count.
void mapEnds(ThreadState& t, GLuint buffer, bool ship);
// Before the program unmaps it: pinned memory stays.
// The last context of the group is gone, and its mappings with it.
void forgetMaps(ShareGroup& group);
void unmaps(ThreadState& t, GLuint buffer);
void mapFlushes(ThreadState& t, GLuint buffer, GLintptr offset, GLsizeiptr length);

// Round trips of these are counted under `by`, the wrapper's name (interposer/asking.hpp).
// Brings the program's own copy of a buffer that the nodes may have written up to date, before it is read.
void refreshBuffer(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length, const char* by = __builtin_FUNCTION());
// Before the buffer is mapped so: what is not written stays, and is not to go back as it was here.
void refreshForMap(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length, GLbitfield access, const char* by = __builtin_FUNCTION());
// The program has waited for the GL: mappings that stay show what the nodes have written until then.
void refreshMaps(ThreadState& t, const char* by = __builtin_FUNCTION());
// From now on buffers may hold what only the nodes know; this one (0: any) is bound where shaders or
// transform feedback write into it.
void nodesMayWrite(ThreadState& t, GLuint buffer);
void buffersMayBeWritten(ThreadState& t, GLsizei count, const GLuint* buffers);
// The program's own context has copied into the buffer. When that came from what only the nodes know, it is old.
void copiedHere(ThreadState& t, GLuint buffer);
// Writes into the program's own copy of a buffer, whatever its storage allows the program.
void writeOwnCopy(ThreadState& t, GLuint buffer, uint64_t offset, const void* bytes, uint64_t length);
// How large it is. False: it is mapped.
bool ownSize(ThreadState& t, GLuint buffer, uint64_t& size);
// Reads it. False: it is mapped, or not so large.
bool readOwnCopy(ThreadState& t, GLuint buffer, uint64_t offset, void* into, uint64_t length);

} // namespace mural
