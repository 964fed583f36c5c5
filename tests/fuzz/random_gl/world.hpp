// One context with all objects that the random calls made in it, and the digest of its output.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/random_gl/memory.hpp"
#include "tests/fuzz/random_gl/random.hpp"
#include "tests/fuzz/random_gl/tables.hpp"
#include "tests/programs/support/gl.hpp"

namespace fuzz {

enum class Profile { Compat, Core, Es1, Es3 };

constexpr int kWidth = 66;
constexpr int kHeight = 50;
constexpr std::size_t kSlots = 6; // objects of each kind

class World {
public:
    World(Profile profile, std::string extensions, bool trace);

    Profile profile;
    bool trace;
    Random random{0, 0};

    [[nodiscard]] bool es() const { return profile == Profile::Es1 || profile == Profile::Es3; }
    [[nodiscard]] bool fixedFunction() const { return profile == Profile::Compat || profile == Profile::Es1; }
    [[nodiscard]] bool shaders() const { return profile != Profile::Es1; }
    [[nodiscard]] bool clientArrays() const { return profile != Profile::Core; }

    // Returns a live name, sometimes 0 or an invalid one.
    GLuint name(Kind kind);
    GLuint living(Kind kind); // 0: none
    GLuint& slot(Kind kind, std::size_t index) { return names_[static_cast<std::size_t>(kind)][index]; }
    void keep(Kind kind, GLuint name); // stores it in any slot
    std::vector<GLsync> syncs;

    // Adds bytes to the transcript's digest of this step.
    void observe(const void* bytes, std::size_t count) { seen_ = digest(bytes, count, seen_); }
    void observe(std::uint64_t value) { observe(&value, sizeof value); }
    std::uint64_t takeSeen();

    // The commands of this context, by family.
    [[nodiscard]] const std::vector<std::vector<const Command*>>& families() const { return families_; }
    [[nodiscard]] bool has(std::string_view extension) const;

    GLuint programVertexArray = 0; // for the core profile, which has no default one
    std::size_t programs = 0;      // made so far

    // Errors fetched within a step: after calls that return a value, and after each call when tracing.
    bool failed(); // since the last call of failed()
    void traceError();
    bool insideBegin = false;
    bool behindVertex = false; // after the first vertex of a primitive
    bool compilesList = false;
    int attributeSize = 4;      // components of vertex attributes
    bool countsSamples = false; // whether a query counts samples
    std::vector<GLenum> errors;

private:
    [[nodiscard]] bool offers(const Command& command) const;

    std::string extensions_; // separated by blanks
    GLuint names_[static_cast<std::size_t>(Kind::Count)][kSlots] = {};
    std::uint64_t seen_ = 0;
    std::vector<std::vector<const Command*>> families_;
};

void traceText(const char* name, const std::string& arguments);

template <class T> std::string shown(T value) {
    if constexpr (std::is_pointer_v<T>) {
        // Addresses of the program's own memory differ between runs.
        const auto address = reinterpret_cast<std::uintptr_t>(value);
        return address > 0x540000000000 ? "..." : shown(address);
    } else if constexpr (std::is_floating_point_v<T>) {
        return std::to_string(value);
    } else {
        char text[32];
        std::snprintf(text, sizeof text, value > 999 ? "0x%llx" : "%lld", static_cast<long long>(value));
        return text;
    }
}

// Makes a call of a recipe, and prints it when tracing.
template <class Function, class... Arguments>
auto call(World& world, const char* name, Function* function, Arguments... arguments) {
    if (world.trace) {
        std::string text;
        ((text += shown(arguments) + " "), ...);
        traceText(name, text);
    }
    if constexpr (std::is_void_v<decltype(function(arguments...))>) {
        function(arguments...);
        world.traceError();
    } else {
        const auto result = function(arguments...);
        world.traceError();
        return result;
    }
}
#define GL(name, ...) call(w, #name, name __VA_OPT__(, ) __VA_ARGS__)

void callAny(World& w); // calls any command of the registry, with more or less valid arguments
void callCommand(World& w, const Command& command);

} // namespace fuzz
