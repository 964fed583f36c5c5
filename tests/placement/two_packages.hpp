// A machine as hwloc writes it down: two packages, each with a NUMA node and some cores. The second
// has a GPU (3D controller) and a network card ib0, the first the display of a management card and eth0.
#pragma once

#include <string>

namespace mural {

std::string twoPackagesXml(unsigned coresEach);

} // namespace mural
