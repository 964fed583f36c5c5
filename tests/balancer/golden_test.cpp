// What a loader must find in the example files: every value of the table in their README.
#include <functional>
#include <set>

#include "balancer/config/resolve.hpp"
#include "balancer/config/text/parser.hpp"
#include "balancer/config/text/value_writer.hpp"
#include "tests/balancer/example_files.hpp"

namespace mural::config {

namespace {

struct Row {
    std::string file, version, resources, destinations, layouts, canvases, compounds, frames, features;
};

std::string trimmed(std::string text) {
    text.erase(0, text.find_first_not_of(' '));
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

std::vector<Row> goldenRows() {
    std::vector<Row> rows;
    std::ifstream in(testing::exampleFolder() / "README.md");
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("| ") || line.find(".eqc |") == std::string::npos) continue;
        std::vector<std::string> cells;
        std::stringstream stream(line.substr(1));
        for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
        if (cells.size() >= 9) rows.push_back({cells[0], cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[7], cells[8]});
    }
    return rows;
}

std::string joined(const std::vector<size_t>& counts) {
    std::string text;
    for (const size_t n : counts) text += (text.empty() ? "" : "/") + std::to_string(n);
    return text;
}

struct CompoundCounts {
    size_t compounds = 0, depth = 0, outputs = 0, inputs = 0;
    void add(const std::vector<Compound>& all, size_t level) {
        for (const Compound& c : all) {
            ++compounds;
            depth = std::max(depth, level);
            outputs += c.outputFrames.size();
            inputs += c.inputFrames.size();
            add(c.children, level + 1);
        }
    }
};

Row found(const ConfigFile& file, const ResolvedConfig& resolved) {
    Row row;
    const Config& c = file.config;
    row.version = numberText(file.version);
    size_t pipes = 0, windows = 0, channels = 0;
    std::vector<Node> nodes = c.nodes;
    nodes.push_back(c.appNode.value_or(Node{})); // which is there even when the file does not say it
    for (const Node& n : nodes) {
        pipes += n.pipes.size();
        for (const Pipe& p : n.pipes) {
            windows += p.windows.size();
            for (const Window& w : p.windows) channels += w.channels.size();
        }
    }
    row.resources = joined({nodes.size(), pipes, windows, channels});
    size_t destinations = 0, views = 0, segments = 0;
    for (const ResolvedChannel& channel : resolved.channels) destinations += channel.isDestination() ? 1 : 0;
    for (const Layout& l : c.layouts) views += l.views.size();
    for (const Canvas& canvas : c.canvases) segments += canvas.segments.size();
    row.destinations = std::to_string(destinations);
    row.layouts = joined({c.layouts.size(), views});
    row.canvases = joined({c.canvases.size(), segments});
    CompoundCounts counts;
    counts.add(c.compounds, 1);
    row.compounds = std::to_string(counts.compounds) + " (" + std::to_string(counts.depth) + ")";
    row.frames = joined({counts.outputs, counts.inputs});
    return row;
}

} // namespace

TEST(ExampleFiles, holdWhatTheirTableSays) {
    const std::vector<Row> rows = goldenRows();
    if (rows.empty()) GTEST_SKIP() << testing::noExamples();
    EXPECT_GE(rows.size(), 58u);
    for (const Row& row : rows) {
        SCOPED_TRACE(row.file);
        Diagnostics diagnostics(row.file);
        const ConfigFile file = readConfigFile((testing::exampleFolder() / row.file).string(), diagnostics);
        const ResolvedConfig resolved = resolve(file, {}, diagnostics);
        EXPECT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
        const Row now = found(file, resolved);
        EXPECT_EQ(now.version, row.version);
        EXPECT_EQ(now.resources, row.resources);
        EXPECT_EQ(now.destinations, row.destinations);
        EXPECT_EQ(now.layouts, row.layouts);
        EXPECT_EQ(now.canvases, row.canvases);
        EXPECT_EQ(now.compounds, row.compounds);
        EXPECT_EQ(now.frames, row.frames);
    }
}

} // namespace mural::config
