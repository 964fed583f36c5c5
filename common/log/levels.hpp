// Topics and levels of log lines, and the parser of MURAL_LOG (docs/reference/logging.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/result.hpp"

namespace mural::log {

// Lines of level Info and above are for the user. Trace and Debug lines are diagnostics.
enum class Level : int8_t { Trace = -2, Debug, Info, Warning, Error, Off }; // zero-initialised levels are Info

enum class Topic : uint8_t {
    Session,   // start, readiness and end of a session; advice about its options
    Node,      // start, loss, restart and resync of nodes
    Program,   // programs that connect and leave
    Stream,    // the way of the commands to the nodes: multicast, own connections, delta coding
    Rsp,       // reliable multicast: members, losses, retransmissions, rate
    Transport, // connections: shared memory, TCP, encryption
    Replay,    // execution of the commands on a node's GL
    Picture,   // readback and transfer of pictures, codecs
    Exchange,  // parts of pictures between nodes
    Output,    // files and windows
    Barrier,   // swap barriers
    Launch,    // start and end of processes
    Daemon,    // nodes that wait for heads
    Discovery, // announcements of such nodes
    Affinity,  // placement of threads
    Trace,     // recordings
    Tool,      // progress of benchmarks and checks
};
inline constexpr size_t kTopics = static_cast<size_t>(Topic::Tool) + 1;

[[nodiscard]] std::string_view nameOf(Topic topic);
[[nodiscard]] std::string_view nameOf(Level level);

using Levels = std::array<Level, kTopics>; // by topic

// Parses a comma-separated list of `[topic:]level`: "debug", "rsp:debug,output:trace", "off". A level without topic
// applies to all topics that the list does not name. Topics without a level have Level::Info. Errors: an unknown topic
// or level; the line names the valid ones.
[[nodiscard]] Result<Levels> parseLevels(std::string_view text);

} // namespace mural::log
