// Words, numbers and lines of a text file. The first problem is kept with its line; later calls return zeros and empty
// words, so a parser checks ok() once per element.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace mural::examples {

class TextCursor {
public:
    // `text` must outlive the cursor. `comment` begins a comment that lasts until the end of the line; 0: none.
    TextCursor(std::string_view text, std::string file, char comment = '\0')
        : text_(text), file_(std::move(file)), comment_(comment) {}

    // The next word of the text; empty at the end of the text.
    std::string_view word() {
        while (skipBlanks() && text_[at_] == '\n') nextLine();
        return takeWord();
    }
    // The next word of this line; empty at the end of the line.
    std::string_view wordOfLine() { return skipBlanks() && text_[at_] != '\n' ? takeWord() : std::string_view{}; }
    // The rest of this line without its end. Moves to the next line.
    std::string_view restOfLine() {
        const size_t begin = at_;
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        std::string_view rest = text_.substr(begin, at_ - begin);
        if (at_ < text_.size()) nextLine();
        if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
        return rest;
    }

    // The next word as a number. Fails with the line and `what` if it is none.
    double number(const char* what) { return parse<double>(word(), what); }
    // The next word as a count from 0 to 2^32 - 1.
    uint32_t count(const char* what) { return parse<uint32_t>(word(), what); }
    // Parses a word as a whole. Accepts a leading plus sign.
    template <class T> T parse(std::string_view word, const char* what) {
        T value{};
        if (!word.empty() && word.front() == '+') word.remove_prefix(1);
        const auto end = word.data() + word.size();
        const auto [stop, problem] = std::from_chars(word.data(), end, value);
        if (!word.empty() && problem == std::errc{} && stop == end) return value;
        fail(word.empty() ? std::string("ends before ") + what : "\"" + shortened(word) + "\" is no " + what);
        return T{};
    }

    [[nodiscard]] bool isAtEnd() const { return at_ == text_.size(); }
    [[nodiscard]] size_t position() const { return at_; }
    [[nodiscard]] size_t bytesLeft() const { return text_.size() - at_; }
    [[nodiscard]] bool ok() const { return problem_.empty(); }
    void fail(const std::string& what) {
        if (ok()) problem_ = file_ + ":" + std::to_string(line_) + ": " + what;
        at_ = text_.size();
    }
    [[nodiscard]] Error error() const { return Error{problem_}; }
    // A word for a message: at most 32 characters, printable.
    static std::string shortened(std::string_view word) {
        std::string text(word.substr(0, 32));
        for (char& c : text) c = c < ' ' || c > '~' ? '?' : c;
        return text + (word.size() > text.size() ? "..." : "");
    }

private:
    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
    // Returns whether any text is left.
    bool skipBlanks() {
        while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
        if (at_ < text_.size() && comment_ != '\0' && text_[at_] == comment_) {
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        }
        return at_ < text_.size();
    }
    std::string_view takeWord() {
        const size_t begin = at_;
        while (at_ < text_.size() && !isBlank(text_[at_]) && text_[at_] != '\n') ++at_;
        return text_.substr(begin, at_ - begin);
    }
    void nextLine() {
        ++at_;
        ++line_;
    }

    std::string_view text_;
    std::string file_;
    char comment_;
    size_t at_ = 0;
    uint64_t line_ = 1;
    std::string problem_;
};

} // namespace mural::examples
