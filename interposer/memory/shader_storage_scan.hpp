// Scans a shader's text for writable storage blocks. Drivers do not report them reliably: Mesa's
// GL_REFERENCED_BY_FRAGMENT_SHADER is false for blocks accessed only at dynamic offsets.
#pragma once

#include <cstddef>

namespace mural {

class StorageScan {
public:
    // Scans the text, in any number of pieces.
    void feed(const char* text, size_t length);
    // Returns true after a block without `readonly`, or a possible one: a macro, an included text.
    [[nodiscard]] bool mayWrite() const { return mayWrite_; }

private:
    enum class In { Code, LineComment, BlockComment };
    void step(char c);
    void endWord();

    static constexpr size_t kWordBytes = 16; // longer words never match
    char word_[kWordBytes] = {};
    size_t wordLength_ = 0;
    char last_ = '\n';
    In in_ = In::Code;
    bool directive_ = false; // on a preprocessor line
    bool lineEmpty_ = true;
    bool buffer_ = false, readonly_ = false; // in the current declaration
    bool mayWrite_ = false;
};

} // namespace mural
