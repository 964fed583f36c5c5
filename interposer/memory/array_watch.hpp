// Wraps a command that moves arrays of a vertex array object into a buffer. Updates the mirror after the driver has
// accepted the command. The driver is queried only if an array was in client memory.
#pragma once

#include <GL/gl.h>
#include <cstdint>

namespace mural {

struct Context;
struct ThreadState;

class ArrayWatch {
public:
    ArrayWatch(const ThreadState& t, GLuint array, uint32_t slot, uint32_t count = 1);
    ~ArrayWatch();
    ArrayWatch(const ArrayWatch&) = delete;
    ArrayWatch& operator=(const ArrayWatch&) = delete;

private:
    Context* context_ = nullptr; // null: no update needed
    GLuint array_;
    uint32_t first_, end_; // slots
};

} // namespace mural
