// Measures distributed objects: encoding, commits, blobs and commits to processes of this machine.
//
//   objects_bench [--quick] [--turns N] [encoding|commits|blobs|fanout]...
//
// Exit status 1 for a wrong result; times are printed, never judged.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tools/bench/objects/benches.hpp"

int main(int argc, char** argv) {
    using namespace mural::bench;
    struct Part {
        const char* name;
        int (*run)(const ObjectBenchOptions&);
        bool isWanted;
    };
    Part parts[] = {{"encoding", benchEncoding, false},
                    {"commits", benchCommits, false},
                    {"blobs", benchBlobs, false},
                    {"fanout", benchFanOut, false}};
    ObjectBenchOptions options;
    bool isAnyWanted = false;
    for (int i = 1; i < argc; ++i) {
        bool isKnown = true;
        if (std::strcmp(argv[i], "--quick") == 0) {
            options.quick = true;
            options.turns = 3;
        } else if (std::strcmp(argv[i], "--turns") == 0 && i + 1 < argc) {
            options.turns = std::max(1, std::atoi(argv[++i]));
        } else {
            isKnown = false;
            for (Part& part : parts)
                if (std::strcmp(argv[i], part.name) == 0) isKnown = isAnyWanted = part.isWanted = true;
        }
        if (isKnown) continue;
        std::fprintf(stderr,
                     "objects_bench: unknown argument %s; use [--quick] [--turns N] [encoding|commits|blobs|fanout]\n",
                     argv[i]);
        return 2;
    }
    int wrong = 0;
    for (const Part& part : parts)
        if (!isAnyWanted || part.isWanted) wrong += part.run(options);
    std::printf("\n%d wrong results\n", wrong);
    return wrong == 0 ? 0 : 1;
}
