// The command `mural bench accuracy`: measures the difference between Mural's pictures and the pictures of one machine.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace mural::cli {

struct BenchArguments {
    std::string what;
    std::string json, svg; // output files; empty: none
    bool quick = false;
    int64_t frames = 30;
    std::vector<std::string> recordings; // traces of `mural run --record`
    std::vector<std::string> program;    // empty: Mural's own scenes
};

void describeBench(CLI::App& command, BenchArguments& arguments);
int benchCommand(const BenchArguments& arguments);

} // namespace mural::cli
