// Prints checks of several hosts: a table, and one line per finding.
#pragma once

#include <string>
#include <vector>

#include "tools/mural/hosts/hosts_verdict.hpp"

namespace mural::cli {

// One row per check, one column per host. Without `all` only rows with findings, or in which the hosts differ. Empty:
// no such row.
std::string tableOf(const std::vector<HostChecks>& hosts, bool all);
// "bad  wall1: clock  +300.0 ms -> `timedatectl …`", worst first.
std::string findingsOf(const std::vector<HostChecks>& hosts);

} // namespace mural::cli
