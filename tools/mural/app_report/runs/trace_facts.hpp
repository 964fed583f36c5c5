// Facts about a program from the trace of its GL stream.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace mural::cli {

struct TraceFacts {
    bool complete = false;                   // false: there is no trace, or its end is missing
    std::string problem;                     // reason why it could not be read
    std::map<std::string, int64_t> contexts; // kinds of contexts, such as "OpenGL 3.3 core", and their number
    std::map<std::string, int64_t> calls;    // GL commands, and the number of their calls
    int64_t frames = 0;
    int64_t clearedFrames = 0;   // frames with a clear of the colour buffers
    int64_t firstFrameBytes = 0; // stream up to the end of the first frame
    int64_t textureBytes = 0, bufferBytes = 0, otherBytes = 0;
    std::set<std::pair<uint32_t, uint32_t>> windowSizes; // of windows that were swapped
    std::string nodesGl;                                 // of a render node
};

TraceFacts readTraceFacts(const std::string& file);

// Returns "OpenGL 3.3 core", "OpenGL ES 2.0", from the arguments of a context's record. profile: bits of
// GLX_CONTEXT_PROFILE_MASK_ARB.
std::string contextName(uint32_t api, uint32_t major, uint32_t minor, uint32_t profile);

} // namespace mural::cli
