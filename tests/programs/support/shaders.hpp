// Compiles and links programs; the info log is the error message.
#pragma once

#include <functional>
#include <initializer_list>

namespace programs {

struct Stage {
    unsigned type; // GL_VERTEX_SHADER …
    const char* source;
};

unsigned compileShader(unsigned type, const char* source);

// `beforeLink` may bind attribute locations or choose transform feedback varyings.
unsigned buildProgram(std::initializer_list<Stage> stages,
                      const std::function<void(unsigned program)>& beforeLink = nullptr);

} // namespace programs
