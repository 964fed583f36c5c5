#include "interposer/memory/shader_storage_scan.hpp"

#include <string_view>

namespace mural {

namespace {

bool inWord(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

} // namespace

void StorageScan::feed(const char* text, size_t length) {
    for (size_t i = 0; i < length && !mayWrite_; ++i) {
        if (text[i] == '\r') continue;
        const In before = in_;
        step(text[i]);
        last_ = in_ == before ? text[i] : ' '; // so that no character counts twice at the start or end of a comment
    }
}

void StorageScan::step(char c) {
    if (in_ == In::BlockComment) {
        if (last_ == '*' && c == '/') in_ = In::Code;
        return;
    }
    if (c == '\n') {
        if (last_ == '\\') return; // line continuation
        if (in_ == In::Code) endWord();
        in_ = In::Code;
        directive_ = false;
        lineEmpty_ = true;
        return;
    }
    if (in_ == In::LineComment) return;
    if (inWord(c)) {
        if (wordLength_ < kWordBytes) word_[wordLength_] = c;
        ++wordLength_;
        lineEmpty_ = false;
        return;
    }
    endWord();
    if (last_ == '/' && (c == '/' || c == '*')) in_ = c == '/' ? In::LineComment : In::BlockComment;
    // a conditional may remove the text before it
    else if (c == '#' && lineEmpty_)
        directive_ = true, readonly_ = false;
    if (c == '{' && buffer_ && !readonly_) mayWrite_ = true;
    if (!directive_ && (c == '{' || c == '}' || c == ';')) buffer_ = readonly_ = false;
    if (c != ' ' && c != '\t' && c != '/') lineEmpty_ = false;
}

void StorageScan::endWord() {
    const std::string_view word(word_, wordLength_ < kWordBytes ? wordLength_ : 0);
    wordLength_ = 0;
    if (directive_) {
        mayWrite_ |= word == "buffer" || word == "include";
        return;
    }
    buffer_ |= word == "buffer";
    readonly_ |= word == "readonly";
}

} // namespace mural
