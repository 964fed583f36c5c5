// Options of `mural run` for the render nodes, their start, and the stream to them.
#include <fmt/format.h>
#include <tuple>

#include "nodes/head/planning/preset_plan.hpp"
#include "tools/mural/run/option_values.hpp"
#include "tools/mural/run/run_option_readers.hpp"
#include "tools/mural/byte_size.hpp"
#include "transport/connection_description.hpp"
#include "transport/rsp/group_description.hpp"

namespace mural::cli {

namespace {

constexpr int kMaxRestarts = 1'000'000;

// Returns the grid for nodes without --tiles: as square as possible, wider than high.
std::pair<int, int> gridFor(int nodes) {
    int rows = 1;
    for (int r = 1; r * r <= nodes; ++r) {
        if (nodes % r == 0) rows = r;
    }
    return {nodes / rows, rows};
}

Result<void> checkStream(const std::string& stream) {
    if (stream == "auto" || stream == "tcp") return {};
    auto parsed = parseConnectionDescription(stream);
    if (!parsed || parsed->kind != ConnectionDescription::Kind::Rsp)
        return badValue("--stream", stream,
                        "must be auto, tcp, or a multicast group such as rsp://239.255.77.1:4277?rate=800mbit");
    auto options = rsp::groupOptionsOf(*parsed);
    if (!options) return Error{"--stream: " + options.error().message};
    return {};
}

} // namespace

Result<void> readNodes(const RunArguments& a, SessionConfig& c) {
    int64_t local = c.localNodes; // --launch local
    if (auto r = readNumber("--local-nodes", a.localNodes, 1, kMaxNodes, local); !r) return r;
    c.localNodes = static_cast<int>(local);
    const int requested = c.localNodes + static_cast<int>(c.hosts.size());
    const int passes = static_cast<int>(passesOf(c.passes).size()) * c.passes.ranges;
    if (requested > 0 && !a.tiles && !a.tileQueue)
        std::tie(c.columns, c.rows) = gridFor(std::max(1, requested / passes));
    if (!sharesParts(c) && requested > c.columns * c.rows * passes) {
        return Error{
            fmt::format("{} render nodes for {} tiles{}: each node needs a tile; give more --tiles or fewer nodes",
                        requested, c.columns * c.rows, passes > 1 ? fmt::format(" in {} passes", passes) : "")};
    }
    if (a.stream) {
        c.stream = *a.stream;
        if (auto r = checkStream(c.stream); !r) return r;
    }
    if (a.cacheSize) {
        const auto size = byteSizeOf(*a.cacheSize);
        if (!size || *size < (1 << 20) || *size > int64_t{1} << 40)
            return badValue("--cache-size", *a.cacheSize, "must be a size from 1MiB to 1024GiB, such as 512MiB");
        c.cacheBytes = *size;
    }
    c.remoteMural = a.remoteMural.value_or("");
    if (a.nodeProgram && a.nodeProgram->empty())
        return badValue("--node-program", "", "must be a program with the native API");
    c.nodeProgram = a.nodeProgram.value_or("");
    int64_t restarts = c.restartNodes;
    if (auto r = readNumber("--restart-nodes", a.restartNodes, 0, kMaxRestarts, restarts); !r) return r;
    c.restartNodes = static_cast<int>(restarts);
    int64_t minNodes = c.minNodes;
    if (auto r = readNumber("--min-nodes", a.minNodes, 1, kMaxRestarts, minNodes); !r) return r;
    c.minNodes = static_cast<int>(minNodes);
    if (requested > 0 && c.minNodes > requested)
        return badValue("--min-nodes", *a.minNodes, fmt::format("must be at most {}, the number of nodes", requested));
    if (!c.spareHosts.empty() && c.restartNodes == 0)
        return Error{"--spare-nodes needs the state that --restart-nodes 0 does not keep; omit one of them"};
    if (c.minNodes > 0 && c.restartNodes == 0)
        return Error{"--min-nodes needs restarts of late nodes, but --restart-nodes 0 disables them; omit one of them"};
    return {};
}

} // namespace mural::cli
