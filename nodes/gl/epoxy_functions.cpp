#include "nodes/gl/epoxy_functions.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>

#include <GL/gl.h>

#include "nodes/gl/dynamic_library.hpp"

namespace mural::gl {
namespace {

// The libraries that libepoxy opens.
enum Library : unsigned { kGl = 1, kEs1 = 2, kEs2 = 4 };

struct Command {
    const char* name;
    unsigned libraries;
};
constexpr Command kCommands[] = {
#include "epoxy_commands.inc"
};

// The platform's own function of each command. Process-wide, like libepoxy's state.
std::array<std::atomic<Proc>, std::size(kCommands)>
    ownFunctions; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

const Command* commandOf(const char* name) {
    const auto* found =
        std::lower_bound(std::begin(kCommands), std::end(kCommands), name,
                         [](const Command& c, const char* wanted) { return std::strcmp(c.name, wanted) < 0; });
    return found != std::end(kCommands) && std::strcmp(found->name, name) == 0 ? found : nullptr;
}

void nothing() {}

// libepoxy calls this before it aborts, because no version or extension of the current context provides the command.
// Another context may provide it, or the driver may have it nevertheless. The driver's function is used then.
void* withoutProvider(const char* name) {
    const Command* command = commandOf(name);
    const Proc own = command ? ownFunctions[static_cast<size_t>(command - kCommands)].load() : nullptr;
    return reinterpret_cast<void*>(own ? own : nothing);
}

struct Libraries {
    DynamicLibrary epoxy, gl, es1, es2;

    // libepoxy aborts if a library lacks a command that it should have.
    [[nodiscard]] bool have(const Command& command) const {
        return (!(command.libraries & kGl) || gl.symbol(command.name)) &&
               (!(command.libraries & kEs1) || es1.symbol(command.name)) &&
               (!(command.libraries & kEs2) || es2.symbol(command.name));
    }
};

// Returns false if another library owns the current context, such as a driver's libEGL in front of the system's.
bool knowsContext(const DynamicLibrary& library) {
    const GLubyte* (*getString)(GLenum) = nullptr;
    return library.load(getString, "glGetString") && getString(GL_VERSION);
}

// Returns nothing if a library is missing, because libepoxy would abort when it needs it, or if one is unusable.
std::optional<Libraries> openLibraries() {
    auto epoxy = DynamicLibrary::open({"libepoxy.so.0"}, "libepoxy0");
    auto gl = DynamicLibrary::open({"libGL.so.1"}, "libgl1");
    auto egl = DynamicLibrary::open({"libEGL.so.1"}, "libegl1");
    auto es1 = DynamicLibrary::open({"libGLESv1_CM.so.1"}, "libgles1");
    auto es2 = DynamicLibrary::open({"libGLESv2.so.2"}, "libgles2");
    using Handler = void* (*)(const char*);
    Handler (*setHandler)(Handler) = nullptr;
    if (!epoxy || !gl || !egl || !es1 || !es2 || !epoxy->load(setHandler, "epoxy_set_resolver_failure_handler"))
        return std::nullopt;
    if (!knowsContext(*gl) || !knowsContext(*es1) || !knowsContext(*es2)) return std::nullopt;
    setHandler(withoutProvider);
    return Libraries{std::move(*epoxy), std::move(*gl), std::move(*es1), std::move(*es2)};
}

} // namespace

Proc throughEpoxy(const char* name, Proc own) {
    const Command* command = own ? commandOf(name) : nullptr;
    if (!command) return own;
    static const std::optional<Libraries> libraries = openLibraries();
    if (!libraries || !libraries->have(*command)) return own;
    const auto* variable = static_cast<const Proc*>(libraries->epoxy.symbol((std::string("epoxy_") + name).c_str()));
    if (!variable) return own; // the command is newer than this libepoxy
    ownFunctions[static_cast<size_t>(command - kCommands)].store(own);
    return *variable;
}

} // namespace mural::gl
