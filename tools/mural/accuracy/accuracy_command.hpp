// mural bench accuracy: how far what Mural makes of a picture is from what one machine draws.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace mural::cli {

struct BenchArguments {
    std::string what;
    std::string json, svg; // files; empty: none
    bool quick = false;
    int64_t frames = 30;
    std::vector<std::string> recordings; // files of `mural run --record`
    std::vector<std::string> program; // empty: Mural's own scenes
};

void describeBench(CLI::App& command, BenchArguments& arguments);
int benchCommand(const BenchArguments& arguments);

} // namespace mural::cli
