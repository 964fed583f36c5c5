// Whether a shader's text declares storage blocks that it may write. Drivers don't tell: Mesa's
// GL_REFERENCED_BY_FRAGMENT_SHADER is false for blocks that are read and written at places not known before the run.
#pragma once

#include <cstddef>

namespace mural {

class StorageScan {
public:
    // The text, in any number of pieces.
    void feed(const char* text, size_t length);
    // A block without `readonly`, or what may stand for one: a macro, a text that is included.
    [[nodiscard]] bool mayWrite() const { return mayWrite_; }

private:
    enum class In { Code, LineComment, BlockComment };
    void step(char c);
    void endWord();

    static constexpr size_t kWordBytes = 16; // longer words are none of ours
    char word_[kWordBytes] = {};
    size_t wordLength_ = 0;
    char last_ = '\n';
    In in_ = In::Code;
    bool directive_ = false;  // on a preprocessor line
    bool lineEmpty_ = true;
    bool buffer_ = false, readonly_ = false; // in the declaration so far
    bool mayWrite_ = false;
};

} // namespace mural
