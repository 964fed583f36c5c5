// Query results that are asked for when the query ends, so that a program which reads them in a later frame finds them
// there: the nodes answer at the swap. Only in contexts whose program does read results that late.
#pragma once

#include <GL/gl.h>
#include <cstdint>
#include <cstdlib>

namespace mural {

struct ThreadState;

class QueryAnswers {
public:
    QueryAnswers() = default;
    QueryAnswers(const QueryAnswers&) = delete;
    QueryAnswers& operator=(const QueryAnswers&) = delete;
    ~QueryAnswers() { std::free(ended_); }

    // index: the vertex stream that it counts, 0 where there is but one.
    void begun(GLenum target, GLuint index, GLuint query);
    void ended(ThreadState& t, GLenum target, GLuint index, uint32_t swaps);
    // The result, when it is known, or was asked for when the query ended before the last swap. False: ask now.
    bool find(GLuint query, uint32_t swaps, uint64_t& value);
    // What the nodes have answered: it stays until the query is begun anew.
    void keep(GLuint query, uint64_t value);

private:
    struct Ended {
        uint32_t swaps;   // of the context until then, + 1; 0: never
        uint32_t request; // 0: not asked
        uint64_t value;
        bool known;
    };
    struct Active {
        GLenum target;
        GLuint index;
        GLuint query; // 0: the place is free
    };
    static constexpr GLuint kNames = 16384; // queries beyond are asked when their results are wanted
    static constexpr int kTargets = 24;

    Ended* ended_ = nullptr; // by the query's name; made with the first
    Active active_[kTargets] = {};
    bool readsLate_ = false;
};

} // namespace mural
