// Benchmarks codecs, kernels and the selector of the compositor on captured planes: compositing_bench FOLDER. Usually
// run by tools/bench/compositing, which captures them. Exit status 1 for a wrong result; times are printed, never
// judged.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/log/process_log.hpp"
#include "tools/bench/picture/benches.hpp"

int main(int argc, char** argv) {
    using namespace mural::bench;
    CLI::App app("Codecs, kernels and the selector of the compositor, on captured planes");
    std::string folder;
    std::vector<std::string> only;
    BenchOptions options;
    app.add_option("FOLDER", folder, "with *.plane files of plane_capture")->required();
    app.add_flag("--quick", options.quick, "few turns: are the results right?");
    app.add_option("--turns", options.turns, "of each measurement")->check(CLI::Range(1, 1000))->capture_default_str();
    app.add_option("--only", only, "codecs, kernels, selector, ranks")
        ->delimiter(',')
        ->check(CLI::IsMember({"codecs", "kernels", "selector", "ranks"}));
    app.add_option("--icet-kernels", options.icetLibrary,
                   "icet_kernels.c built against IceT, to be measured beside ours");
    CLI11_PARSE(app, argc, argv);
    if (options.quick) options.turns = 2;
    const auto wanted = [&](const char* part) { return only.empty() || std::ranges::find(only, part) != only.end(); };

    if (const auto started = mural::log::start("compositing_bench", "compositing_bench: "); !started) {
        fmt::print(stderr, "compositing_bench: {}\n", started.error().message);
        return 1;
    }
    auto planes = readPlanes(folder);
    if (!planes) {
        fmt::print(stderr, "compositing_bench: {}\n", planes.error().message);
        return 1;
    }
    Faults faults;
    const auto run = [&](const char* part, auto&& bench) {
        if (!wanted(part)) return;
        const Faults found = bench(*planes, options);
        faults.insert(faults.end(), found.begin(), found.end());
    };
    run("codecs", benchCodecs);
    run("kernels", benchKernels);
    run("selector", benchSelector);
    run("ranks", benchRanks);
    for (const std::string& fault : faults) fmt::print(stderr, "compositing_bench: {}\n", fault);
    fmt::print("\n{} planes, {} wrong results\n", planes->size(), faults.size());
    return faults.empty() ? 0 : 1;
}
