// Link status of a program, and the locations of a linked program by name. The nodes' drivers may number uniforms
// differently.
#pragma once

#include <GL/gl.h>

#include "streamcodec/wire/control_records.hpp"

namespace mural {

struct Context;
struct ThreadState;

// Returns false for an unlinked or unknown program, and where the driver rejects queries. Leaves the program's error
// state unchanged.
bool isLinked(Context& context, GLuint program);
// Binds every active attribute to its location here; takes effect when the nodes link.
void bindAttributes(ThreadState& t, GLuint program);
// kOpProgramLayout: u32 count, then (i32 location, u32 length, name…) per uniform, padded to 4 bytes.
void sendLayout(ThreadState& t, GLuint program);

} // namespace mural
