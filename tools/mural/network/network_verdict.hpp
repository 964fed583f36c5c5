// What is to be mended: from measured facts to lines with a next step. Pure, so tests can ask it anything.
#pragma once

#include <vector>

#include "tools/mural/doctor_checks.hpp"
#include "tools/mural/network/host_measured.hpp"

namespace mural::cli {

// The checks' names tell what they are about: "card", "buffers", "wall1: multicast".
std::vector<Check> judgeHere(const HereMeasured& here);
std::vector<Check> judgeHost(const HereMeasured& here, const HostMeasured& host);

} // namespace mural::cli
