// Runs `mural doctor --nodes`: examines all hosts of a wall at once, and prints differences and faults.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace mural::cli {

struct HostsArguments {
    std::string hosts;      // comma-separated
    std::string configFile; // --config; empty: none
    std::string recordings; // folder for recordings; empty: the home folder
    bool all = false;       // also rows without findings
    bool fix = false;       // print a script instead of the table
};

struct NetworkArguments;

// Adds the options to doctor and returns --nodes, which the others require. `arguments` must outlive the parsing.
CLI::Option* describeHostsDoctor(CLI::App& doctor, HostsArguments& arguments);
// network: launch command, path of mural, group and interface. Returns 0, 1 with warnings, 2 with faults.
int hostsDoctorCommand(const HostsArguments& arguments, const NetworkArguments& network, bool asJson);

} // namespace mural::cli
