// Debug output: errors, groups, messages and filters of the program, labels; through a callback and through the log.
// The received messages are shown as numbers, so one too many or too few is a wrong pixel.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>

using namespace programs;

namespace {

struct MessageCounter {
    std::uint32_t count = 0;
    std::uint32_t hash = 5381;
    void add(GLenum source, GLenum type, GLenum severity, const GLchar* text) {
        ++count;
        for (const std::uint32_t value : {source, type, severity}) {
            hash = hash * 33 + value;
        }
        for (; *text != 0; ++text) {
            hash = hash * 33 + std::uint8_t(*text);
        }
    }
};
MessageCounter counted, logged;

void APIENTRY countMessage(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* text,
                           const void* user) {
    static_cast<MessageCounter*>(const_cast<void*>(user))->add(source, type, severity, text);
}

void insert(GLenum severity, const char* text) {
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_MARKER, 12, severity, -1, text);
}

void makeErrors() {
    glEnable(GL_TEXTURE_BINDING_2D);
    glBindTexture(0x1234, 1);
    glDrawArrays(0x4321, 0, 3);
    glDrawArrays(GL_TRIANGLES, 0, -1);
    for (int i = 0; i < 5; ++i) {
        (void)glGetError();
    }
}

void readLog() {
    for (;;) {
        GLenum source = 0, type = 0, severity = 0;
        GLuint id = 0;
        GLsizei length = 0;
        GLchar text[1024];
        if (glGetDebugMessageLog(1, sizeof text, &source, &type, &id, &severity, &length, text) == 0) {
            return;
        }
        logged.add(source, type, severity, text);
    }
}

void labels() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glObjectLabel(GL_TEXTURE, texture, -1, "a texture with a name");
    GLchar label[64] = "";
    glGetObjectLabel(GL_TEXTURE, texture, sizeof label, nullptr, label);
    showBits(8, std::uint32_t(std::strlen(label)));
    glObjectLabel(GL_TEXTURE, texture, 5, "other than this");
    glGetObjectLabel(GL_TEXTURE, texture, sizeof label, nullptr, label);
    showBits(9, std::uint32_t(std::strlen(label)));
    glObjectLabel(GL_TEXTURE, texture, 0, nullptr);
    const GLsync sync = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glObjectPtrLabel(sync, -1, "a fence");
    glGetObjectPtrLabel(sync, sizeof label, nullptr, label);
    showBits(10, std::uint32_t(std::strlen(label)));
    glDeleteSync(sync);
    glDeleteTextures(1, &texture);
}

// Receives messages with the callback, with groups and filters.
void listen() {
    glDebugMessageCallback(countMessage, &counted);
    void* function = nullptr;
    void* user = nullptr;
    glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &function);
    glGetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &user);
    showBits(5,
             std::uint32_t(function == reinterpret_cast<void*>(&countMessage)) * 2 + std::uint32_t(user == &counted));
    makeErrors();
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 3, -1, "a group");
    glDebugMessageControl(GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    makeErrors();
    insert(GL_DEBUG_SEVERITY_HIGH, "in the group");
    glPopDebugGroup();
    makeErrors();
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_LOW, 0, nullptr, GL_FALSE);
    insert(GL_DEBUG_SEVERITY_LOW, "not heard");
    insert(GL_DEBUG_SEVERITY_MEDIUM, "heard");
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_LOW, 0, nullptr, GL_TRUE);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            glEnable(GL_DEBUG_OUTPUT);
            glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        },
        [](Window& window, int frame) {
            glClearColor(0.1F, 0.1F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            listen();
            glDebugMessageCallback(nullptr, nullptr);
            makeErrors();
            insert(GL_DEBUG_SEVERITY_HIGH, "for the log");
            readLog();
            labels();
            showBits(1, counted.count);
            showBits(2, counted.hash);
            showBits(3, logged.count);
            showBits(4, logged.hash);
            fillRectangle(20 + frame * 7, 90, window.width() / 2, window.height() / 3, {0.8F, 0.4F, 0.2F});
        });
}
