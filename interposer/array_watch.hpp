// Around a command that lets arrays of a vertex array object lie in a buffer from now on: the mirror learns it when the
// driver has taken the command. That is asked only where one of them was in the program's own memory.
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
    Context* context_ = nullptr; // null: there is nothing to learn
    GLuint array_;
    uint32_t first_, end_; // slots
};

} // namespace mural
