// Splits a configuration into words, numbers, strings and brackets with positions. Equalizer's reader drops commas and
// unknown characters silently; this lexer drops them too, and warns where a mistake is likely.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "balancer/config/diagnostics.hpp"

namespace mural::config {

enum class TokenKind : uint8_t {
    Word,
    Number,    // verbatim; the reader of the field interprets it
    String,    // without quotes
    Character, // the character between single quotes
    Bracket,   // one of { } [ ] ( )
    End,
};

struct Token {
    TokenKind kind = TokenKind::End;
    std::string_view text; // view into the input
    SourcePosition at;

    [[nodiscard]] bool is(char bracket) const { return kind == TokenKind::Bracket && text.front() == bracket; }
};

struct TokenList {
    double version = 0;               // from the header line "#Equalizer 1.2 ascii"; 0: no header
    std::vector<std::string> heading; // comments before the first token
    std::vector<Token> tokens;        // the last one is End
    bool failed = false;              // a string is unterminated; the tokens stop there
};

// The tokens refer to `text`, which must outlive them.
TokenList tokenize(std::string_view text, Diagnostics& diagnostics);

} // namespace mural::config
