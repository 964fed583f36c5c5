#include "balancer/config/eqc/token_reader.hpp"

namespace mural::config {

const Token& TokenReader::take() {
    const Token& token = tokens_[at_];
    if (at_ + 1 < tokens_.size()) ++at_;
    return token;
}

bool TokenReader::accept(char bracket) {
    if (!peek().is(bracket)) return false;
    take();
    return true;
}

bool TokenReader::expect(char bracket, std::string_view after) {
    if (accept(bracket)) return true;
    const bool opens = bracket == '{' || bracket == '[' || bracket == '(';
    fail(peek().at,
         std::string(after) + (opens ? " begins with " : " ends with ") + bracket + ", found " + shown(peek()),
         opens ? "add it" : "add it, or check for a missing bracket before it");
    return false;
}

void TokenReader::fail(SourcePosition at, std::string what, std::string remedy) {
    if (!failed_) diagnostics_.error(at, std::move(what), std::move(remedy));
    failed_ = true;
    at_ = tokens_.size() - 1;
}

void TokenReader::skipValue() {
    for (;;) {
        const Token& token = peek();
        if (token.is('{') || token.is('[') || token.is('(')) {
            skipBrackets();
        } else if (token.kind == TokenKind::Number || token.kind == TokenKind::String ||
                   token.kind == TokenKind::Character) {
            take();
        } else {
            return;
        }
    }
}

// Counts brackets without matching their kinds, because the contents are not read.
void TokenReader::skipBrackets() {
    int depth = 0;
    do {
        const Token& token = take();
        if (token.kind != TokenKind::Bracket) continue;
        depth += token.is('{') || token.is('[') || token.is('(') ? 1 : -1;
    } while (depth > 0 && !ended());
}

std::string shown(const Token& token) {
    const std::string text(token.text.substr(0, 40));
    switch (token.kind) {
    case TokenKind::Word: return "the word " + text;
    case TokenKind::Number: return "the number " + text;
    case TokenKind::String: return "\"" + text + "\"";
    case TokenKind::Character: return "'" + text + "'";
    case TokenKind::Bracket: return text;
    case TokenKind::End: break;
    }
    return "the end of the file";
}

} // namespace mural::config
