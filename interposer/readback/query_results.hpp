// Prefetches query results: requests them when a query ends, so that they have arrived when the program reads them in a
// later frame. The nodes answer at the swap. Active only in contexts whose program reads results that late.
#pragma once

#include <GL/gl.h>
#include <cstdint>
#include <cstdlib>

namespace mural {

struct ThreadState;

class QueryResults {
public:
    QueryResults() = default;
    QueryResults(const QueryResults&) = delete;
    QueryResults& operator=(const QueryResults&) = delete;
    ~QueryResults() { std::free(ended_); }

    // index: the vertex stream; 0 for targets without streams.
    void begun(GLenum target, GLuint index, GLuint query);
    void ended(ThreadState& t, GLenum target, GLuint index, uint32_t swaps);
    // Returns the result if it is known, or was requested before the last swap. False: request it now.
    bool find(GLuint query, uint32_t swaps, uint64_t& value);
    // Stores the nodes' result until the query begins again.
    void keep(GLuint query, uint64_t value);

private:
    struct Ended {
        uint32_t swaps;   // swap count of the context at its end, plus 1; 0: never ended
        uint32_t request; // 0: not requested
        uint64_t value;
        bool known;
    };
    struct Active {
        GLenum target;
        GLuint index;
        GLuint query; // 0: a free entry
    };
    static constexpr GLuint kNames = 16384; // higher names are not prefetched
    static constexpr int kTargets = 24;

    Ended* ended_ = nullptr; // by query name; allocated on first use
    Active active_[kTargets] = {};
    bool readsLate_ = false;
};

} // namespace mural
