// A machine in hwloc's XML format: two packages, each with a NUMA node and some cores. The second has a GPU (3D
// controller) and the network card ib0. The first has the display of a management card and eth0.
#pragma once

#include <string>

namespace mural {

std::string twoPackagesXml(unsigned coresEach);

} // namespace mural
