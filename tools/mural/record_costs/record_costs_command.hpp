// The command `mural record-costs`: measures what each cell of a program's picture and each part of its draws costs,
// and writes a cost trace for `mural simulate`.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace mural::cli {

struct RecordCostsArguments {
    std::string out;          // file of the trace
    std::string grid = "8x6"; // cells of the picture
    int ranges = 32;          // parts of the range
    int frames = 100;
    int rounds = 3;
    int smooth = 9;       // frames of a median
    std::string size;     // WxH; empty: the program's own
    double seconds = 120; // limit of each run
    std::vector<std::string> program;
};

extern const char* const kRecordCostsFooter;

void describeRecordCosts(CLI::App& command, RecordCostsArguments& arguments);
int recordCostsCommand(const RecordCostsArguments& arguments);

} // namespace mural::cli
