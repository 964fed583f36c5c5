// The tokens of a GLSL text: enough of the language to find names, directives and declarations.
// Comments are skipped; names inside of macro definitions count, as the compiler will see them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mural::shaders {

struct GlslToken {
    std::string_view text;    // of the source
    size_t at = 0;            // where it begins
    bool directive = false;   // on a preprocessor line
};

struct GlslDirective {
    std::string_view name;    // "version", "extension", …; empty: a lone #
    size_t begin = 0;         // of the #
    size_t end = 0;           // after the line's end
    int depth = 0;            // conditionals around it; an #if and its #endif are at the same depth
};

struct GlslText {
    std::string_view source;
    std::vector<GlslToken> tokens;
    std::vector<GlslDirective> directives;
    int version = 110;
    bool es = false;

    [[nodiscard]] bool uses(std::string_view name) const;
    [[nodiscard]] bool usesPrefix(std::string_view prefix) const;
    // Behind #version: where #extension lines go.
    [[nodiscard]] size_t extensionsAt() const;
    // Behind the last #extension, outside of all conditionals: where declarations may go.
    [[nodiscard]] size_t declarationsAt() const;
};

// es: what a text without #version is (ES 1.00 in ES contexts, 1.10 elsewhere).
GlslText scanGlsl(std::string_view source, bool es);

// Insertions and replacements, gathered in any order and applied at once.
class TextEdits {
public:
    void insert(size_t at, std::string text) { replace(at, 0, std::move(text)); }
    void replace(size_t at, size_t length, std::string text) { edits_.push_back({at, length, std::move(text)}); }
    [[nodiscard]] bool empty() const { return edits_.empty(); }
    [[nodiscard]] std::string apply(std::string_view source) const;

private:
    struct Edit {
        size_t at, length;
        std::string text;
    };
    std::vector<Edit> edits_;
};

// A declaration to be put at `at`: on the line that is there when that is none of the preprocessor's,
// so that __LINE__ and messages stay as they were.
std::string onItsLine(const GlslText& text, size_t at, std::string declaration);

} // namespace mural::shaders
