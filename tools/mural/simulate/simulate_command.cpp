#include "tools/mural/simulate/simulate_command.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "balancer/simulation/measures.hpp"
#include "balancer/simulation/scenes.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/simulate/efficiency_plot.hpp"

namespace mural::cli {

namespace {

using simulation::Conditions;
using simulation::CostTrace;
using simulation::Measures;
using simulation::Outcome;
using simulation::Strategy;

constexpr Strategy kAll[] = {Strategy::Even,    Strategy::Load,     Strategy::LoadUndamped, Strategy::Tree,
                             Strategy::CostMap, Strategy::ExactMap, Strategy::AsInFile};

struct Row {
    std::string scene;
    Strategy strategy;
    Measures measures; // means over the seeds
    int follow = -1;   // frames to follow the step of the scene; -1: no step
    Outcome last;
};

int fail(const std::string& message, int status = launch::kExitUsage) {
    fmt::print(stderr, "mural simulate: {}\n", message);
    return status;
}

Result<std::vector<Strategy>> strategiesOf(const SimulateArguments& a) {
    if (a.compare) return std::vector<Strategy>(std::begin(simulation::kCompared), std::end(simulation::kCompared));
    for (const Strategy s : kAll)
        if (a.equalizer == simulation::nameOf(s)) return std::vector<Strategy>{s};
    std::string names;
    for (const Strategy s : kAll) names += std::string(names.empty() ? "" : ", ") + simulation::nameOf(s);
    return Error{"there is no equalizer " + a.equalizer + "; there are " + names};
}

// Returns one trace per seed. A file is the same for all seeds.
Result<CostTrace> traceOf(const SimulateArguments& a, const std::string& name, uint32_t seed) {
    if (const simulation::Scene* scene = simulation::findScene(name))
        return simulation::makeScene(*scene, static_cast<size_t>(a.frames), seed);
    return simulation::readCostTrace(name);
}

std::vector<std::string> sceneNames(const SimulateArguments& a) {
    if (a.cost != "all") return {a.cost};
    std::vector<std::string> names;
    for (const simulation::Scene& s : simulation::scenes()) names.emplace_back(s.name);
    return names;
}

Conditions conditionsOf(const SimulateArguments& a, uint32_t seed) {
    Conditions c;
    c.latency = a.latency;
    c.noise = a.noise;
    c.speeds = a.speeds;
    c.overlap = a.overlap;
    c.assembly = a.assembly;
    c.frames = static_cast<size_t>(a.frames);
    c.layouts = a.layouts;
    c.seed = seed;
    return c;
}

void add(Measures& sum, const Measures& m, double weight) {
    sum.mean += weight * m.mean;
    sum.fifth += weight * m.fifth;
    sum.travel += weight * m.travel;
    sum.worseThanEven += weight * m.worseThanEven;
    sum.lastMove = std::max(sum.lastMove, m.lastMove);
    sum.settled = std::max(sum.settled, m.settled);
}

Result<std::vector<Row>> simulateScene(const SimulateArguments& a, const config::ResolvedConfig& config,
                                       const std::string& scene, const std::vector<Strategy>& strategies) {
    std::vector<Row> rows;
    for (const Strategy s : strategies) rows.push_back({scene, s, {}, -1, {}});
    const simulation::Scene* synthetic = simulation::findScene(scene);
    for (int i = 0; i < a.seeds; ++i) {
        const uint32_t seed = a.seed + static_cast<uint32_t>(i);
        auto trace = traceOf(a, scene, seed);
        if (!trace) return trace.error();
        const Conditions conditions = conditionsOf(a, seed);
        const std::string problem = simulation::problemOf(config, *trace, conditions);
        if (!problem.empty()) return Error{problem};
        const Outcome even = simulation::simulate(config, *trace, conditions, Strategy::Even);
        for (Row& row : rows) {
            row.last = simulation::simulate(config, *trace, conditions, row.strategy);
            add(row.measures, simulation::measuresOf(row.last, even), 1. / a.seeds);
            if (synthetic != nullptr && synthetic->stepFrame > 0 && a.frames > synthetic->stepFrame + 10)
                row.follow =
                    std::max(row.follow, simulation::framesToFollow(row.last, synthetic->stepFrame, a.latency));
        }
    }
    return rows;
}

void printTable(const std::vector<Row>& rows) {
    fmt::print("{:<12} {:<14} {:>10} {:>6} {:>9} {:>10} {:>9} {:>7} {:>15}\n", "scene", "equalizer", "efficiency", "p5",
               "travel", "last move", "settled", "follow", "worse than even");
    for (const Row& r : rows) {
        const Measures& m = r.measures;
        fmt::print("{:<12} {:<14} {:>10.3f} {:>6.3f} {:>9.4f} {:>10} {:>9} {:>7} {:>13.1f} %\n", r.scene,
                   simulation::nameOf(r.strategy), m.mean, m.fifth, m.travel, m.lastMove, m.settled,
                   r.follow < 0 ? "-" : std::to_string(r.follow), 100 * m.worseThanEven);
    }
}

void printMeans(const std::vector<Row>& rows, const std::vector<Strategy>& strategies) {
    fmt::print("\n{:<12} {:<14} {:>10}\n", "all scenes", "equalizer", "efficiency");
    for (const Strategy s : strategies) {
        double sum = 0, count = 0;
        for (const Row& r : rows) {
            if (r.strategy != s) continue;
            sum += r.measures.mean;
            ++count;
        }
        fmt::print("{:<12} {:<14} {:>10.3f}\n", "", simulation::nameOf(s), sum / count);
    }
}

void printJson(const SimulateArguments& a, const std::vector<Row>& rows) {
    nlohmann::json all = nlohmann::json::array();
    for (const Row& r : rows) {
        const Measures& m = r.measures;
        nlohmann::json row = {{"scene", r.scene},           {"equalizer", simulation::nameOf(r.strategy)},
                              {"efficiency", m.mean},       {"p5", m.fifth},
                              {"travel", m.travel},         {"lastMove", m.lastMove},
                              {"settled", m.settled},       {"worseThanEven", m.worseThanEven},
                              {"frames", r.last.efficiency}};
        if (r.follow >= 0) row["follow"] = r.follow;
        all.push_back(std::move(row));
    }
    const nlohmann::json document = {{"nodes", a.nodes}, {"latency", a.latency}, {"noise", a.noise},
                                     {"seed", a.seed},   {"seeds", a.seeds},     {"rows", all}};
    fmt::print("{}\n", jsonText(document));
}

Result<void> writeFile(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (out) return {};
    return Error{path + " can't be written: " + std::strerror(errno) + "; name another file"};
}

Result<void> plot(const SimulateArguments& a, const std::vector<Row>& rows) {
    std::vector<EfficiencyCurve> curves;
    for (const Row& r : rows) {
        if (r.scene != rows.front().scene) continue;
        const std::string name = simulation::nameOf(r.strategy);
        curves.push_back({name, r.last.efficiency, r.measures.mean});
    }
    const std::string title =
        fmt::format("Efficiency of {}: {} nodes, latency {}, {:.0f} % noise, seed {}", rows.front().scene, a.nodes,
                    a.latency, 100 * a.noise, a.seed + static_cast<uint32_t>(a.seeds - 1));
    return writeFile(a.plot, efficiencyPlot(title, curves));
}

Result<compound::LoadedConfig> configOf(const SimulateArguments& a) {
    if (a.config.empty()) {
        if (!a.layouts.empty()) return Error{"--layout needs a configuration"};
        const auto mode = a.mode == "db" ? config::SplitMode::Db : config::SplitMode::TwoD;
        return simulation::dividedConfig(static_cast<size_t>(a.nodes), mode);
    }
    auto loaded = compound::loadConfig(a.config, compound::processEnvironment);
    if (!loaded.ok()) return Error{loaded.diagnostics.firstError()};
    return loaded;
}

int writeTrace(const SimulateArguments& a) {
    auto trace = traceOf(a, a.cost, a.seed);
    if (!trace) return fail(trace.error().message);
    std::ofstream out(a.write, std::ios::binary | std::ios::trunc);
    simulation::writeCostTrace(*trace, out);
    out.close();
    return out ? 0 : fail(a.write + " can't be written: " + std::strerror(errno) + "; name another file", 1);
}

} // namespace

const char* const kSimulateFooter =
    "Examples:\n"
    "  mural simulate --cost corner --nodes 16 --compare           all equalizers on one scene\n"
    "  mural simulate --cost all --nodes 64 --latency 2 --seeds 5 --compare\n"
    "  mural simulate wall.eqc --cost trace.cost --equalizer file  the equalizers of a configuration\n"
    "  mural simulate --cost moving --nodes 8 --compare --plot efficiency.svg\n\n"
    "Efficiency: the sum of the nodes' times / (nodes * longest time). docs/reference/cost-trace.md describes traces.\n"
    "Exit status: 0, 1 when a file could not be written, 2 for a bad argument.";

void describeSimulate(CLI::App& command, SimulateArguments& a) {
    command.add_option("CONFIG", a.config, "configuration (.eqc); default: one picture divided among --nodes nodes");
    command.add_option("--cost", a.cost, "cost trace: a file, a scene of --list, or all scenes")->type_name("TRACE");
    command.add_option("--layout", a.layouts, "with CONFIG: the layout to show, by name or number; repeatable")
        ->type_name("NAME");
    command.add_option("--nodes", a.nodes, "without CONFIG: nodes that share the picture (8)")
        ->type_name("N")
        ->check(CLI::Range(2, 1024));
    command.add_option("--mode", a.mode, "without CONFIG: divide the picture (2d) or the range (db)")
        ->check(CLI::IsMember({"2d", "db"}));
    command.add_option("--latency", a.latency, "frames until the times of a frame are known (1)")
        ->type_name("L")
        ->check(CLI::Range(1, 64));
    command.add_option("--noise", a.noise, "standard deviation of the times, as a fraction (0.03)")
        ->type_name("X")
        ->check(CLI::Range(0., 1.));
    command.add_option("--speeds", a.speeds, "speeds of the nodes, repeated as needed (1)")
        ->type_name("S,S...")
        ->delimiter(',')
        ->check(CLI::Range(.001, 1000.));
    command.add_option("--overlap", a.overlap, "part of the cost that each node pays for objects on its edges (0)")
        ->type_name("C")
        ->check(CLI::Range(0., 1.));
    command.add_option("--assembly", a.assembly, "seconds that the destination needs per picture of a helper (0)")
        ->type_name("SECONDS")
        ->check(CLI::Range(0., 1000.));
    command.add_option("--frames", a.frames, "frames (100)")->type_name("F")->check(CLI::Range(2, 100000));
    command.add_option("--seed", a.seed, "first seed of noise and scenes (1)")->type_name("S");
    command.add_option("--seeds", a.seeds, "seeds to average over (1)")->type_name("N")->check(CLI::Range(1, 1000));
    command
        .add_option("--equalizer", a.equalizer,
                    "even, load, load-undamped, tree, costmap, exact, or file: as CONFIG says (costmap)")
        ->type_name("NAME");
    command.add_flag("--compare", a.compare, "all equalizers, one after the other");
    command.add_option("--plot", a.plot, "draw the efficiencies of the first scene and the last seed")
        ->type_name("FILE.svg");
    command.add_option("--write-trace", a.write, "write the trace and exit")->type_name("FILE");
    command.add_flag("--list", a.list, "list the synthetic scenes");
    command.add_flag("--json", a.json, "results as JSON, with the efficiency of each frame");
}

int simulateCommand(const SimulateArguments& a) {
    if (a.list) {
        for (const simulation::Scene& s : simulation::scenes()) fmt::print("{:<10} {}\n", s.name, s.what);
        return 0;
    }
    if (a.cost.empty()) return fail("--cost is needed: a trace, a scene of --list, or all (see mural simulate --help)");
    if (!a.write.empty()) return writeTrace(a);
    auto strategies = strategiesOf(a);
    if (!strategies) return fail(strategies.error().message);
    auto loaded = configOf(a);
    if (!loaded) return fail(loaded.error().message);
    std::vector<Row> rows;
    for (const std::string& scene : sceneNames(a)) {
        auto some = simulateScene(a, loaded->resolved, scene, *strategies);
        if (!some) return fail(some.error().message);
        for (Row& r : *some) rows.push_back(std::move(r));
    }
    if (a.json) {
        printJson(a, rows);
    } else {
        printTable(rows);
        if (a.cost == "all") printMeans(rows, *strategies);
    }
    if (a.plot.empty()) return 0;
    const auto written = plot(a, rows);
    return written ? 0 : fail(written.error().message, 1);
}

} // namespace mural::cli
