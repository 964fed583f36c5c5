// Runs `mural doctor --network`: surveys the network, derives diagnoses, and prints them.
#pragma once

#include "tools/mural/network/network_arguments.hpp"

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace mural::cli {

// Adds the options to doctor and returns --network. Some options require it; --launch, --remote-mural, --group and
// --interface require it or --nodes. `arguments` must outlive the parsing.
CLI::Option* describeNetworkDoctor(CLI::App& doctor, NetworkArguments& arguments);
int networkDoctorCommand(const NetworkArguments& arguments, bool asJson);

} // namespace mural::cli
