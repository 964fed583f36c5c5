// `mural help`: describes a command, and writes the manual pages.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace mural::cli {

extern const char* const kHelpFooter;

struct HelpArguments {
    std::string command;   // empty: mural itself
    std::string manFolder; // --man; empty: print the help
};

void describeHelp(CLI::App& help, HelpArguments& arguments);
int helpCommand(CLI::App& mural, const HelpArguments& arguments);

} // namespace mural::cli
