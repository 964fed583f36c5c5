#include "interposer/context/extensions.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "interposer/context/context.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/command_table.hpp"
#include "streamcodec/local_extensions.hpp"

namespace mural {

namespace {

// Images of GL objects are available if the nodes support them.
const char* const kWindowSystemOfNodes[] = {"EGL_KHR_image_base", "EGL_KHR_gl_texture_2D_image",
                                            "EGL_KHR_gl_texture_cubemap_image", "EGL_KHR_gl_texture_3D_image",
                                            "EGL_KHR_gl_renderbuffer_image"};

bool oneOf(const char* const* names, size_t count, const char* name, size_t length) {
    for (size_t i = 0; i < count; ++i) {
        if (std::strlen(names[i]) == length && !std::strncmp(names[i], name, length)) return true;
    }
    return false;
}
template <size_t N> bool oneOf(const LocalExtension (&extensions)[N], const char* name, size_t length) {
    for (const LocalExtension& e : extensions) {
        if (std::strlen(e.name) == length && !std::strncmp(e.name, name, length)) return true;
    }
    return false;
}
template <size_t N> bool oneOf(const char* const (&names)[N], const char* name, size_t length) {
    return oneOf(names, N, name, length);
}

// name: surrounded by spaces.
bool nodesHave(const char* name) {
    Session* s = Session::get();
    return !s || std::strlen(s->nodeExtensions()) <= 2 || std::strstr(s->nodeExtensions(), name);
}

bool advertised(const char* name, size_t length) {
    char text[128];
    if (length == 0 || length + 3 > sizeof text) return false;
    text[0] = ' ';
    std::memcpy(text + 1, name, length);
    text[length + 1] = ' ';
    text[length + 2] = 0;
    if (!nodesHave(text)) return false;
    text[length + 1] = 0;
    return extensionCarried(text + 1);
}

// Copies a driver's text without the names that keep() rejects, in the driver's order. Old programs read only the first
// kilobytes, where drivers list old extensions.
template <typename Keep> void copyFiltered(const char* text, char* out, Keep storedName) {
    for (const char* p = text; *p;) {
        const size_t length = std::strcspn(p, " ");
        if (storedName(p, length)) {
            std::memcpy(out, p, length);
            out += length;
            *out++ = ' ';
        }
        p += length;
        while (*p == ' ') ++p;
    }
    *out = 0;
}

void makeText(Context& c) {
    if (c.extensionText) return;
    const auto* whole = reinterpret_cast<const char*>(gReal.glGetString(GL_EXTENSIONS));
    if (!whole) return;
    c.extensionText = static_cast<char*>(std::malloc(std::strlen(whole) + 2));
    if (c.extensionText) copyFiltered(whole, c.extensionText, advertised);
}

// Programs keep these pointers after Mesa has unloaded the driver that contains the text, with its last EGL display.
// The pointers therefore refer to the registry's copies or to permanent copies.
struct StoredName {
    StoredName* next;
    char name[1];
};
StoredName* storedNames = nullptr;
Lock namesLock;

const char* storedName(const char* name) {
    const size_t length = std::strlen(name);
    if (const char* registered = registeredExtension({name, length})) return registered;
    Guard guard(namesLock);
    for (const StoredName* k = storedNames; k; k = k->next) {
        if (!std::strcmp(k->name, name)) return k->name;
    }
    auto* filtered = static_cast<StoredName*>(std::malloc(sizeof(StoredName) + length));
    if (!filtered) return name;
    std::memcpy(filtered->name, name, length + 1);
    filtered->next = storedNames;
    storedNames = filtered;
    return filtered->name;
}

// Indexed names follow the driver's indexed order, which differs from the string's.
void makeNames(Context& c) {
    if (c.extensionCount >= 0 || c.version < 30 || !gReal.glGetStringi) return;
    GLint count = 0;
    gReal.glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    c.extensionNames = static_cast<const char**>(std::malloc(sizeof(char*) * (static_cast<size_t>(count) + 1)));
    if (!c.extensionNames) return;
    c.extensionCount = 0;
    for (GLint i = 0; i < count; ++i) {
        const auto* name = reinterpret_cast<const char*>(gReal.glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
        if (name && advertised(name, std::strlen(name))) c.extensionNames[c.extensionCount++] = storedName(name);
    }
}

// A queried window-system string and its filtered version.
struct Filtered {
    const char* text;
    const char* filtered;
    Filtered* next;
};
Filtered* filteredTexts = nullptr;
Lock filterLock;

bool isVisible(const char* name, size_t length) {
    if (length == 0 || oneOf(kLocalWindowExtensions, name, length)) return false;
    if (!oneOf(kWindowSystemOfNodes, name, length)) return true;
    char text[64];
    snprintf(text, sizeof text, " %.*s ", static_cast<int>(length), name);
    return nodesHave(text);
}

} // namespace

const char* adjustedString(Context& c, GLenum name) {
    if (name == GL_EXTENSIONS && !c.core) {
        makeText(c);
        return c.extensionText;
    }
    return nullptr;
}

const char* extensionAt(Context& c, GLuint index) {
    makeNames(c);
    return c.extensionCount > 0 && index < static_cast<GLuint>(c.extensionCount) ? c.extensionNames[index] : nullptr;
}

GLint extensionCount(Context& c) {
    makeNames(c);
    return c.extensionCount;
}

const char* filterWindowSystemExtensions(const char* text) {
    if (!text) return nullptr;
    Guard guard(filterLock);
    for (const Filtered* f = filteredTexts; f; f = f->next) {
        if (!std::strcmp(f->text, text)) return f->filtered;
    }
    const size_t length = std::strlen(text);
    auto* made = static_cast<Filtered*>(std::malloc(sizeof(Filtered)));
    auto* copy = static_cast<char*>(std::malloc(2 * length + 3));
    if (!made || !copy) return text;
    std::memcpy(copy, text, length + 1);
    char* filtered = copy + length + 1;
    copyFiltered(text, filtered, isVisible);
    *made = {copy, filtered, filteredTexts};
    filteredTexts = made;
    return filtered;
}

} // namespace mural
