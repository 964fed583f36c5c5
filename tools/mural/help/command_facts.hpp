// The command line as data. Manual pages and the completion of shells are made from it, so both have every option.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace mural::cli {

struct OptionFacts {
    std::vector<std::string> names; // "-o", "--out"; of a positional argument: its name alone
    std::string value;              // name of the value, such as FILE; empty: a flag
    std::string meaning;
    std::string limits;               // of a number, such as "0.1 to 600"; empty: none
    std::vector<std::string> choices; // the only values; empty: others
    std::vector<std::string> needs;   // options that must be present
    bool isPositional = false;
    bool isRequired = false;
    bool isValueOptional = false; // "--verify=N" or "--verify"
};

struct CommandFacts {
    std::string name; // "run"; of mural itself: empty
    std::string meaning;
    std::string usage;  // "mural run [OPTIONS] -- PROGRAM ARGUMENTS..."
    std::string footer; // text after the options of --help: examples, exit status
    std::vector<OptionFacts> options;
    bool takesProgram = false;  // a program and its arguments may follow "--"
    bool startsProgram = false; // the first word that is no option begins the program, also without "--"
    bool isHidden = false;      // for Mural's own processes
};

// Returns the facts of mural itself, then the facts of its subcommands.
std::vector<CommandFacts> factsOf(CLI::App& mural);

// Returns the command; null: there is none.
const CommandFacts* commandNamed(const std::vector<CommandFacts>& commands, const std::string& name);

} // namespace mural::cli
