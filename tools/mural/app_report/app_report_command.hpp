// The command `mural app-report`: reports before a show what a program will do on a wall.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace mural::cli {

struct AppReportArguments {
    double seconds = 10;    // limit of each run
    std::string size;       // WxH; empty: the program's own
    std::string json, html; // output files; empty: none
    bool noPictures = false;
    std::vector<std::string> diff; // two reports to compare instead
    std::vector<std::string> program;
};

extern const char* const kAppReportFooter;

void describeAppReport(CLI::App& command, AppReportArguments& arguments);
int appReportCommand(const AppReportArguments& arguments);

} // namespace mural::cli
