// A tokenizer for GLSL, sufficient to find names, directives and declarations. Skips comments. Names in macro
// definitions count as the compiler sees them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mural::shaders {

struct GlslToken {
    std::string_view text;  // in the source
    size_t at = 0;          // offset of its first character
    bool directive = false; // on a preprocessor line
};

struct GlslDirective {
    std::string_view name; // "version", "extension", …; empty: a lone #
    size_t begin = 0;      // of the #
    size_t end = 0;        // after the end of the line
    int depth = 0;         // number of enclosing conditionals; an #if and its #endif have the same depth
};

struct GlslText {
    std::string_view source;
    std::vector<GlslToken> tokens;
    std::vector<GlslDirective> directives;
    int version = 110;
    bool es = false;

    [[nodiscard]] bool uses(std::string_view name) const;
    [[nodiscard]] bool usesPrefix(std::string_view prefix) const;
    // The position for #extension lines, after #version.
    [[nodiscard]] size_t extensionsAt() const;
    // The position for declarations: after the last #extension, outside all conditionals.
    [[nodiscard]] size_t declarationsAt() const;
};

// es: selects the version of a text without #version (ES 1.00, otherwise 1.10).
GlslText scanGlsl(std::string_view source, bool es);

// Collects insertions and replacements in any order, and applies them together.
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

// Formats a declaration for insertion at `at`: on the existing line unless it is a preprocessor line, so that __LINE__
// and messages do not change.
std::string onItsLine(const GlslText& text, size_t at, std::string declaration);

} // namespace mural::shaders
