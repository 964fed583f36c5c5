// Reads the value of a field. An error stops the reader with one line that names the expected value.
#pragma once

#include "balancer/config/config.hpp"
#include "balancer/config/eqc/token_reader.hpp"
#include "balancer/config/eqc/words.hpp"

namespace mural::config {

class ValueReader {
public:
    // field: name for messages.
    ValueReader(TokenReader& tokens, std::string_view field) : tokens_(tokens), field_(field) {}

    void read(std::string& value);
    void read(char& value);
    void read(double& value);
    void read(uint32_t& value);
    void read(int32_t& value);
    void read(Viewport& value);
    void read(Vector3& value);
    void read(Degrees2& value);
    void read(Range& value);
    void read(Zoom& value);
    void read(PixelKernel& value);
    void read(SubPixel& value);
    void read(Bezel& value);
    void read(PixelsOrRange& value);
    void read(Reference& value);
    void read(LayoutReference& value);
    void read(ChannelReference& value);

    // Reads a word of an enumeration. Early releases wrote some words in lower case.
    template <class E>
    requires std::is_enum_v<E>
    void read(E& value) {
        const Token& token = tokens_.take();
        for (const auto& s : spellings(E{})) {
            if (token.kind == TokenKind::Word && takesAs(token, s.word)) {
                value = s.value;
                if (wordOf(s.value) != s.word) replaced(token, wordOf(s.value));
                return;
            }
        }
        std::string choices;
        for (const auto& s : spellings(E{})) {
            if (wordOf(s.value) == s.word) choices += (choices.empty() ? "" : ", ") + std::string(s.word);
        }
        tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token), "use one of " + choices);
    }

    // [ A B ]
    template <class E> void read(EnumSet<E>& value) {
        value = {};
        if (!tokens_.expect('[', field_)) return;
        while (!tokens_.ended() && !tokens_.peek().is(']')) {
            if (ignoredMember(E{})) continue;
            E member{};
            read(member);
            value.add(member);
        }
        tokens_.expect(']', field_);
    }

    // Reads an attribute value: ON, AUTO, CORE 1, 16, ...
    void readAttribute(int32_t& value);

private:
    bool takesAs(const Token& token, std::string_view word);
    void replaced(const Token& token, std::string_view by);
    bool ignoredMember(Buffer);
    template <class E> bool ignoredMember(E) { return false; }
    template <class... T> void readList(T&... values);

    TokenReader& tokens_;
    std::string_view field_;
};

// Returns true if the word is a valid attribute value.
bool isAttributeWord(std::string_view word);

} // namespace mural::config
