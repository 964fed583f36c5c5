// The commands of all findings as a script for a shell: `mural doctor --nodes … --fix`.
#pragma once

#include <string>
#include <vector>

#include "tools/mural/hosts/hosts_verdict.hpp"

namespace mural::cli {

// Each finding is a comment with its advice, and its commands follow. Commands for a host run there by launchCommand.
// Commands that only examine, that need a decision, or that have a word to fill in, are in the comment only. Pure.
std::string fixScriptOf(const std::vector<HostChecks>& hosts, const std::string& launchCommand);

} // namespace mural::cli
