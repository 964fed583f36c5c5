#include "nodes/shaders/glsl_tokens.hpp"

#include <algorithm>
#include <charconv>

namespace mural::shaders {

namespace {

bool nameStart(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool nameChar(char c) { return nameStart(c) || (c >= '0' && c <= '9'); }
bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

class Scanner {
public:
    Scanner(std::string_view source, bool es) : s_(source) {
        out_.source = source;
        out_.es = es;
        out_.version = es ? 100 : 110;
    }

    GlslText scan() {
        while (at_ < s_.size()) step();
        closeDirective(s_.size());
        readVersion();
        return std::move(out_);
    }

private:
    [[nodiscard]] char peek(size_t ahead = 0) const { return at_ + ahead < s_.size() ? s_[at_ + ahead] : '\0'; }

    void step() {
        const char c = peek();
        if (c == '\\' && (peek(1) == '\n' || (peek(1) == '\r' && peek(2) == '\n'))) {
            at_ += peek(1) == '\n' ? 2 : 3; // line continuation
        } else if (c == '\n') {
            ++at_;
            closeDirective(at_);
            lineEmpty_ = true;
        } else if (blank(c)) {
            ++at_;
        } else if (c == '/' && (peek(1) == '/' || peek(1) == '*')) {
            skipComment();
        } else if (c == '#' && lineEmpty_ && !inDirective_) {
            inDirective_ = true;
            lineEmpty_ = false;
            out_.directives.push_back({{}, at_++, 0, depth_});
        } else {
            lineEmpty_ = false;
            token();
        }
    }

    void skipComment() {
        if (peek(1) == '/') {
            // A backslash continues a line comment, as it does any line.
            while (at_ < s_.size() && s_[at_] != '\n') at_ += s_[at_] == '\\' && peek(1) == '\n' ? 2 : 1;
            return;
        }
        const size_t end = s_.find("*/", at_ + 2);
        at_ = end == std::string_view::npos ? s_.size() : end + 2;
    }

    void token() {
        const size_t begin = at_;
        if (nameStart(s_[at_])) {
            while (at_ < s_.size() && nameChar(s_[at_])) ++at_;
        } else if (s_[at_] >= '0' && s_[at_] <= '9') {
            while (at_ < s_.size() && (nameChar(s_[at_]) || s_[at_] == '.')) ++at_;
        } else {
            ++at_;
        }
        const std::string_view text = s_.substr(begin, at_ - begin);
        if (inDirective_ && out_.directives.back().name.empty()) {
            out_.directives.back().name = text;
            if (text == "endif" && depth_ > 0) out_.directives.back().depth = --depth_;
            if (text == "if" || text == "ifdef" || text == "ifndef") ++depth_;
        }
        out_.tokens.push_back({text, begin, inDirective_});
    }

    void closeDirective(size_t end) {
        if (inDirective_) out_.directives.back().end = end;
        inDirective_ = false;
    }

    void readVersion() {
        for (size_t i = 0; i + 1 < out_.tokens.size(); ++i) {
            if (!out_.tokens[i].directive || out_.tokens[i].text != "version") continue;
            const std::string_view number = out_.tokens[i + 1].text;
            std::from_chars(number.data(), number.data() + number.size(), out_.version);
            out_.es = out_.version == 100 ||
                      (i + 2 < out_.tokens.size() && out_.tokens[i + 2].directive && out_.tokens[i + 2].text == "es");
            return;
        }
    }

    std::string_view s_;
    GlslText out_;
    size_t at_ = 0;
    int depth_ = 0;
    bool lineEmpty_ = true;
    bool inDirective_ = false;
};

} // namespace

GlslText scanGlsl(std::string_view source, bool es) { return Scanner(source, es).scan(); }

bool GlslText::uses(std::string_view name) const {
    return std::any_of(tokens.begin(), tokens.end(), [&](const GlslToken& t) { return t.text == name; });
}

bool GlslText::usesPrefix(std::string_view prefix) const {
    return std::any_of(tokens.begin(), tokens.end(),
                       [&](const GlslToken& t) { return t.text.substr(0, prefix.size()) == prefix; });
}

size_t GlslText::extensionsAt() const {
    for (const GlslDirective& d : directives) {
        if (d.name == "version") return d.end;
    }
    return 0;
}

size_t GlslText::declarationsAt() const {
    size_t at = extensionsAt();
    bool pending = false; // an #extension inside open conditionals
    for (const GlslDirective& d : directives) {
        if (d.name == "extension") {
            pending = d.depth > 0;
            if (!pending) at = d.end;
        } else if (pending && d.name == "endif" && d.depth == 0) {
            pending = false;
            at = d.end;
        }
    }
    return at;
}

std::string TextEdits::apply(std::string_view source) const {
    std::vector<Edit> sorted = edits_;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Edit& a, const Edit& b) { return a.at != b.at ? a.at < b.at : a.length < b.length; });
    std::string out;
    size_t at = 0;
    for (const Edit& e : sorted) {
        out.append(source.substr(at, e.at - at));
        out += e.text;
        at = e.at + e.length;
    }
    out.append(source.substr(at));
    return out;
}

std::string onItsLine(const GlslText& text, size_t at, std::string declaration) {
    size_t next = at;
    while (next < text.source.size() && blank(text.source[next])) ++next;
    const bool ends = at > 0 && text.source[at - 1] != '\n'; // the last line may lack a newline
    const bool directive = next < text.source.size() && text.source[next] == '#';
    return (ends ? "\n" : "") + std::move(declaration) + (directive ? "\n" : " ");
}

} // namespace mural::shaders
