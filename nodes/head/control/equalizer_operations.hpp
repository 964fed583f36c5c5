// The operations of the control interface for equalizers: list, set a parameter, freeze.
#pragma once

#include "nodes/head/control/control_operations.hpp"
#include "nodes/head/control/equalizer_control.hpp"

namespace mural {

// `equalizers` must outlive the operations.
void addEqualizerOperations(ControlOperations& operations, EqualizerControl& equalizers);

} // namespace mural
