// Iterates over the tokens of a file. After the first error only the end of the file follows, so every loop over tokens
// terminates.
#pragma once

#include "balancer/config/eqc/lexer.hpp"

namespace mural::config {

class TokenReader {
public:
    TokenReader(const std::vector<Token>& tokens, Diagnostics& diagnostics)
        : tokens_(tokens), diagnostics_(diagnostics) {}

    [[nodiscard]] const Token& peek() const { return tokens_[at_]; }
    [[nodiscard]] bool ended() const { return peek().kind == TokenKind::End; }
    [[nodiscard]] bool failed() const { return failed_; }
    const Token& take();
    // Consumes the bracket if it is next.
    bool accept(char bracket);
    // Consumes the bracket, or reports an error. `after`: the word that it belongs to.
    bool expect(char bracket, std::string_view after);

    void fail(SourcePosition at, std::string what, std::string remedy);
    void warn(SourcePosition at, std::string what, std::string remedy) {
        diagnostics_.warn(at, std::move(what), std::move(remedy));
    }
    void given(SourcePosition at, std::string_view section, std::string_view field) {
        diagnostics_.given(at, section, field);
    }

    // Skips the possible value of an unknown word: numbers, texts, brackets with their contents.
    void skipValue();

private:
    void skipBrackets();

    const std::vector<Token>& tokens_;
    Diagnostics& diagnostics_;
    size_t at_ = 0;
    bool failed_ = false;
};

// Describes the token for messages: "}", the word "foo", or the end of the file.
std::string shown(const Token& token);

} // namespace mural::config
