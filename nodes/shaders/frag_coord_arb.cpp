// Rewrites coordinates in programs of ARB_fragment_program, an assembly language (withWindowOffsetArb).
#include <cctype>
#include <charconv>
#include <vector>

#include "nodes/shaders/frag_coord.hpp"
#include "nodes/shaders/glsl_tokens.hpp"

namespace mural::shaders {

namespace {

// Tokens are names, numbers and single characters; # starts a comment.
std::vector<GlslToken> scanArb(std::string_view s) {
    std::vector<GlslToken> tokens;
    for (size_t at = 0; at < s.size();) {
        const auto c = static_cast<unsigned char>(s[at]);
        if (c == '#') {
            at = std::min(s.find('\n', at), s.size());
        } else if (std::isspace(c)) {
            ++at;
        } else {
            size_t end = at + 1;
            const auto word = [&](char ch) {
                return std::isalnum(static_cast<unsigned char>(ch)) || ch == '_' || ch == '$';
            };
            while (word(s[at]) && end < s.size() && word(s[end])) ++end;
            tokens.push_back({s.substr(at, end - at), at, false});
            at = end;
        }
    }
    return tokens;
}

struct Arb {
    std::vector<GlslToken> tokens;
    [[nodiscard]] std::string_view at(size_t i) const {
        return i < tokens.size() ? tokens[i].text : std::string_view{};
    }
    [[nodiscard]] bool position(size_t i) const {
        return at(i) == "fragment" && at(i + 1) == "." && at(i + 2) == "position";
    }
};

bool namesEnv(const Arb& arb, int index) {
    for (size_t i = 0; i < arb.tokens.size(); ++i) {
        if (arb.at(i) != "env" || arb.at(i + 1) != "[") continue;
        int last = -1; // of a range: env[0..3]
        for (size_t k = i + 2; k < arb.tokens.size() && arb.at(k) != "]"; ++k) {
            const std::string_view text = arb.at(k);
            std::from_chars(text.data(), text.data() + text.size(), last);
        }
        if (last >= index) return true;
    }
    return false;
}

// The index after the header and the OPTION lines; 0: not a fragment program.
size_t firstStatement(const Arb& arb) {
    size_t i = 0;
    while (i < arb.tokens.size() && arb.at(i).substr(0, 5) != "ARBfp") ++i;
    i += 3; // ARBfp1 . 0
    if (i > arb.tokens.size()) return 0;
    while (arb.at(i) == "OPTION") {
        while (i < arb.tokens.size() && arb.at(i) != ";") ++i;
        ++i;
    }
    return i < arb.tokens.size() ? arb.tokens[i].at : 0;
}

} // namespace

std::optional<std::string> withWindowOffsetArb(std::string_view source, int envIndex) {
    const Arb arb{scanArb(source)};
    const size_t first = firstStatement(arb);
    if (first == 0 || namesEnv(arb, envIndex - 1)) return std::nullopt;
    bool upper = false, whole = false; // origin upper left; integer pixel centres
    TextEdits edits;
    for (size_t i = 0; i < arb.tokens.size(); ++i) {
        upper = upper || arb.at(i) == "ARB_fragment_coord_origin_upper_left";
        whole = whole || arb.at(i) == "ARB_fragment_coord_pixel_center_integer";
        if (!arb.position(i)) continue;
        const GlslToken& last = arb.tokens[i + 2];
        edits.replace(arb.tokens[i].at, last.at + last.text.size() - arb.tokens[i].at, "muralPosition");
        // ATTRIB accepts inputs only; ALIAS accepts a variable.
        if (i >= 3 && arb.at(i - 3) == "ATTRIB") edits.replace(arb.tokens[i - 3].at, 6, "ALIAS");
    }
    if (edits.empty()) return std::nullopt;
    const std::string from = "program.env[" + std::to_string(envIndex) + "]." + (upper ? "xzzz" : "xyyy");
    const std::string more = "program.env[" + std::to_string(envIndex - 1) + "]";
    edits.insert(
        first, "TEMP muralPosition; MAD muralPosition.xy, fragment.position, " + more + ", " + from + "; " +
                   (whole ? "MAD muralPosition.xy, " + more + ", 0.5, muralPosition; " : "") +
                   "ADD muralPosition.xy, muralPosition, fragment.position; MOV muralPosition.zw, fragment.position; ");
    return edits.apply(source);
}

} // namespace mural::shaders
