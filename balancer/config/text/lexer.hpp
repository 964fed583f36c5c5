// Words, numbers, strings and brackets of a configuration's text, with their places. What the original reader drops
// without a word (commas, unknown characters) is dropped here, too; with a warning where it may be a mistake.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "balancer/config/diagnostics.hpp"

namespace mural::config {

enum class TokenKind : uint8_t {
    Word,
    Number,    // as it is written: what it may be is known to who reads it
    String,    // without its quotes
    Character, // the one between single quotes
    Bracket,   // one of { } [ ] ( )
    End,
};

struct Token {
    TokenKind kind = TokenKind::End;
    std::string_view text; // part of the text that was given
    SourcePosition at;

    [[nodiscard]] bool is(char bracket) const { return kind == TokenKind::Bracket && text.front() == bracket; }
};

struct TokenList {
    double version = 0; // of the header line "#Equalizer 1.2 ascii"; 0 without one
    std::vector<std::string> heading; // comments before the first token
    std::vector<Token> tokens;        // the last one is End
    bool failed = false;              // a text has no end: the tokens stop there
};

// The tokens point into `text`.
TokenList tokenize(std::string_view text, Diagnostics& diagnostics);

} // namespace mural::config
