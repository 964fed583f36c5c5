// Mapped buffers. Data that the program writes is sent to the nodes, and data that the nodes write is fetched. The
// mapping itself belongs to the program's own context.
#pragma once

#include <GL/gl.h>
#include <cstdint>

namespace mural {

struct ShareGroup;
struct ThreadState;

// Call after the program has mapped a range of the buffer at `memory`, with the access bits of glMapBufferRange.
void mapBegins(ThreadState& t, GLuint buffer, void* memory, uint64_t offset, uint64_t length, GLbitfield access);
// Call when the buffer begins to use client memory (AMD_pinned_memory), which both sides may write at any time.
void pinBegins(ThreadState& t, GLuint buffer, void* memory, uint64_t length);
// Call before an unmap, new storage or deletion ends the mapping. `ship`: its data is still valid.
void mapEnds(ThreadState& t, GLuint buffer, bool ship);
// Drops all mappings of the group. Call when its last context is destroyed.
void forgetMaps(ShareGroup& group);
// Call before the program unmaps the buffer. Pinned memory stays.
void unmaps(ThreadState& t, GLuint buffer);
void mapFlushes(ThreadState& t, GLuint buffer, GLintptr offset, GLsizeiptr length);

// Updates the program's own copy of a buffer that the nodes may have written, before it is read. Round trips are
// counted under `by`, the wrapper's name (interposer/readback/node_requests.hpp).
void refreshBuffer(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length,
                   const char* by = __builtin_FUNCTION());
// The same before a mapping with this access: unwritten bytes must not overwrite the nodes' with outdated values.
void refreshForMap(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length, GLbitfield access,
                   const char* by = __builtin_FUNCTION());
// Call after the program has waited for the GL. Updates persistent mappings with data written by the nodes.
void refreshMaps(ThreadState& t, const char* by = __builtin_FUNCTION());
// From now on only the nodes have the current content of buffers. This buffer (0: any) is bound for writes by shaders
// or transform feedback.
void nodesMayWrite(ThreadState& t, GLuint buffer);
void buffersMayBeWritten(ThreadState& t, GLsizei count, const GLuint* buffers);
// Call after the program's own context has copied into the buffer. If only the nodes have the current source, the copy
// is outdated.
void copiedHere(ThreadState& t, GLuint buffer);
// Writes into the program's own copy of a buffer, even if its storage forbids it to the program.
void writeOwnCopy(ThreadState& t, GLuint buffer, uint64_t offset, const void* bytes, uint64_t length);
// The size of the program's own copy. Returns false if it is mapped.
bool ownSize(ThreadState& t, GLuint buffer, uint64_t& size);
// Reads it. Returns false if it is mapped or too small.
bool readOwnCopy(ThreadState& t, GLuint buffer, uint64_t offset, void* into, uint64_t length);

} // namespace mural
