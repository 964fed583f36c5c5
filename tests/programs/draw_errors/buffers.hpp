// Buffers that the draws of these programs read, equal in every API. Include the API's header first.
#pragma once

namespace programs {

struct DrawBuffers {
    GLuint vertexArray = 0, vertices = 0, indices = 0, indirect = 0;
};

// Creates and binds the buffers. `indirect` holds 256 bytes with two commands first, and also serves dispatches.
inline DrawBuffers makeDrawBuffers() {
    const GLfloat corners[12] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, 0};
    const GLushort order[4] = {0, 1, 2, 0};
    const GLuint commands[64] = {3, 1, 0, 0, 0, 3, 1, 0, 0, 0};
    DrawBuffers b;
    glGenVertexArrays(1, &b.vertexArray);
    glBindVertexArray(b.vertexArray);
    glGenBuffers(1, &b.vertices);
    glBindBuffer(GL_ARRAY_BUFFER, b.vertices);
    glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glGenBuffers(1, &b.indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, b.indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof order, order, GL_STATIC_DRAW);
    glGenBuffers(1, &b.indirect);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, b.indirect);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, b.indirect);
    glBufferData(GL_DRAW_INDIRECT_BUFFER, sizeof commands, commands, GL_STATIC_DRAW);
    return b;
}

} // namespace programs
