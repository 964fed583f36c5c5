// Walks over the tokens of a file. The first error ends the reading: from then on there is only the end of the file, so
// that every loop over tokens ends by itself.
#pragma once

#include "balancer/config/text/lexer.hpp"

namespace mural::config {

class TokenReader {
public:
    TokenReader(const std::vector<Token>& tokens, Diagnostics& diagnostics) : tokens_(tokens), diagnostics_(diagnostics) {}

    [[nodiscard]] const Token& peek() const { return tokens_[at_]; }
    [[nodiscard]] bool ended() const { return peek().kind == TokenKind::End; }
    [[nodiscard]] bool failed() const { return failed_; }
    const Token& take();
    // Takes the bracket when it is next.
    bool accept(char bracket);
    // An error when it is not next. `after`: what it belongs to.
    bool expect(char bracket, std::string_view after);

    void fail(SourcePosition at, std::string what, std::string remedy);
    void warn(SourcePosition at, std::string what, std::string remedy) { diagnostics_.warn(at, std::move(what), std::move(remedy)); }
    void given(SourcePosition at, std::string_view section, std::string_view field) { diagnostics_.given(at, section, field); }

    // Steps over what may be the value of a word that nobody knows: numbers, texts, brackets with all that is in them.
    void skipValue();

private:
    void skipBrackets();

    const std::vector<Token>& tokens_;
    Diagnostics& diagnostics_;
    size_t at_ = 0;
    bool failed_ = false;
};

// The token in words, for messages: "}" or the word "foo" or the end of the file.
std::string shown(const Token& token);

} // namespace mural::config
