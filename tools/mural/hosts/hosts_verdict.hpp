// Derives checks with next steps from the examination of hosts. Pure, so tests cover every case.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/mural/doctor/doctor_checks.hpp"
#include "tools/mural/hosts/expected_screens.hpp"
#include "tools/mural/hosts/hosts_survey.hpp"

namespace mural::cli {

struct HostChecks {
    std::string host;
    std::vector<Check> checks; // names are the rows of the table
};

// expected: the displays of each host that a configuration file names; may be empty.
std::vector<HostChecks> judgeHosts(const HostsSurvey& survey,
                                   const std::map<std::string, std::vector<ExpectedScreen>>& expected);

// The worst health of all checks.
Health worstOf(const std::vector<HostChecks>& hosts);

} // namespace mural::cli
