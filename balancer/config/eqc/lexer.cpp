#include "balancer/config/eqc/lexer.hpp"

#include <charconv>

namespace mural::config {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }
// Commas and semicolons between values are ignored.
bool isSilent(char c) { return isSpace(c) || c == ',' || c == ';'; }

class Lexer {
public:
    Lexer(std::string_view text, Diagnostics& diagnostics) : text_(text), diagnostics_(diagnostics) {}

    TokenList run() {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3; // byte order mark
        while (at_ < text_.size() && !list_.failed) step();
        trimHeading();
        list_.tokens.push_back({TokenKind::End, text_.substr(text_.size()), here()});
        return std::move(list_);
    }

private:
    [[nodiscard]] char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
    [[nodiscard]] SourcePosition here() const { return {line_, static_cast<int32_t>(at_ - lineStart_) + 1}; }

    void advance() {
        if (text_[at_] == '\n') {
            ++line_;
            lineStart_ = at_ + 1;
        }
        ++at_;
    }

    void add(TokenKind kind, size_t from, size_t size, SourcePosition at) {
        list_.tokens.push_back({kind, text_.substr(from, size), at});
    }

    void step() {
        const char c = peek();
        if (isSilent(c))
            advance();
        else if (c == '#' || (c == '/' && peek(1) == '/'))
            comment();
        else if (c == '"')
            string();
        else if (c == '\'' && at_ + 2 < text_.size() && text_[at_ + 2] == '\'' && text_[at_ + 1] != '\n')
            character();
        else if (std::string_view("{}[]()").find(c) != std::string_view::npos)
            bracket();
        else if (startsNumber())
            number();
        else if (isLetter(c))
            word();
        else
            stray();
    }

    void comment() {
        if (text_.substr(at_).starts_with("#Equalizer") && header()) return;
        const size_t from = at_ + (peek() == '#' ? 1 : 2);
        const size_t end = std::min(text_.find('\n', at_), text_.size());
        if (list_.tokens.empty()) {
            std::string_view line = end > from ? text_.substr(from, end - from) : std::string_view{};
            if (line.starts_with(' ')) line.remove_prefix(1);
            while (!line.empty() && isSpace(line.back())) line.remove_suffix(1);
            list_.heading.emplace_back(line);
        }
        at_ = end;
    }

    // Reads "#Equalizer 1.2 ascii", which precedes everything but comments.
    bool header() {
        const SourcePosition at = here();
        size_t i = at_ + std::string_view("#Equalizer").size();
        const auto skipBlanks = [&] {
            while (i < text_.size() && (text_[i] == ' ' || text_[i] == '\t')) ++i;
        };
        skipBlanks();
        double version = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + i, text_.data() + text_.size(), version, std::chars_format::fixed);
        i = static_cast<size_t>(end - text_.data());
        skipBlanks();
        const bool whole =
            error == std::errc{} && version >= 0 && version < 100 && text_.substr(i).starts_with("ascii");
        if (!whole) {
            diagnostics_.warn(at, "unknown header, it is read as a comment", "write: #Equalizer 1.2 ascii");
            return false;
        }
        if (!list_.tokens.empty() || list_.version != 0) {
            diagnostics_.warn(at, "the header must be the first line, this one is read as a comment", "remove it");
            return false;
        }
        list_.version = version;
        at_ = i + std::string_view("ascii").size();
        return true;
    }

    void string() {
        const SourcePosition at = here();
        const size_t from = at_ + 1;
        const size_t end = text_.find_first_of("\"\n", from);
        if (end == std::string_view::npos || text_[end] == '\n') {
            diagnostics_.error(at, "this string is not terminated", "close it with \" on the same line");
            list_.failed = true;
            return;
        }
        add(TokenKind::String, from, end - from, at);
        at_ = end + 1;
    }

    void character() {
        add(TokenKind::Character, at_ + 1, 1, here());
        at_ += 3;
    }

    void bracket() {
        add(TokenKind::Bracket, at_, 1, here());
        ++at_;
    }

    void word() {
        const size_t from = at_;
        const SourcePosition at = here();
        while (isLetter(peek()) || isDigit(peek())) ++at_;
        add(TokenKind::Word, from, at_ - from, at);
    }

    [[nodiscard]] bool startsNumber() const {
        const size_t sign = peek() == '+' || peek() == '-' ? 1 : 0;
        return isDigit(peek(sign)) || (peek(sign) == '.' && isDigit(peek(sign + 1)));
    }

    void number() {
        const size_t from = at_;
        const SourcePosition at = here();
        if (peek() == '2' && peek(1) == 'D' && !isLetter(peek(2)) && !isDigit(peek(2))) { // an equalizer mode
            at_ += 2;
            return add(TokenKind::Word, from, 2, at);
        }
        if (!isDigit(peek()) && peek() != '.') ++at_;
        while (isDigit(peek())) ++at_;
        if (peek() == '.') ++at_;
        while (isDigit(peek())) ++at_;
        if (exponentFollows()) {
            diagnostics_.warn(at, "numbers have no exponents", "write all digits");
            at_ += 2;
            while (isDigit(peek())) ++at_;
        }
        add(TokenKind::Number, from, at_ - from, at);
        if ((peek() == 'f' || peek() == 'F') && !isLetter(peek(1)) && !isDigit(peek(1))) ++at_; // "1.f", as in C
    }

    [[nodiscard]] bool exponentFollows() const {
        if (peek() != 'e' && peek() != 'E') return false;
        return isDigit(peek(1)) || ((peek(1) == '+' || peek(1) == '-') && isDigit(peek(2)));
    }

    void stray() {
        const size_t from = at_;
        const SourcePosition at = here();
        const auto known = [&] {
            return isSilent(peek()) || isLetter(peek()) || isDigit(peek()) ||
                   std::string_view("{}[]()\"#").find(peek()) != std::string_view::npos;
        };
        do ++at_;
        while (at_ < text_.size() && !known());
        std::string shown;
        for (const char c : text_.substr(from, std::min<size_t>(at_ - from, 8))) shown += c >= ' ' && c < 127 ? c : '?';
        diagnostics_.warn(at, "\"" + shown + "\" is not part of the syntax and is ignored", "remove it");
    }

    void trimHeading() {
        auto& lines = list_.heading;
        while (!lines.empty() && lines.back().empty()) lines.pop_back();
        while (!lines.empty() && lines.front().empty()) lines.erase(lines.begin());
    }

    std::string_view text_;
    Diagnostics& diagnostics_;
    TokenList list_;
    size_t at_ = 0;
    size_t lineStart_ = 0;
    int32_t line_ = 1;
};

} // namespace

TokenList tokenize(std::string_view text, Diagnostics& diagnostics) { return Lexer(text, diagnostics).run(); }

} // namespace mural::config
