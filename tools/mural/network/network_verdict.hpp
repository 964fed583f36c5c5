// Derives diagnoses with next steps from measurements. Pure, so tests cover every case.
#pragma once

#include <vector>

#include "tools/mural/doctor/doctor_checks.hpp"
#include "tools/mural/network/host_measured.hpp"

namespace mural::cli {

// Names of checks identify their subject: "card", "buffers", "wall1: multicast".
std::vector<Check> judgeHere(const HereMeasured& here);
std::vector<Check> judgeHost(const HereMeasured& here, const HostMeasured& host);

} // namespace mural::cli
