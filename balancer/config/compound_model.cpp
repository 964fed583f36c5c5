#include "balancer/config/compound_model.hpp"

namespace mural::config {

// Outside of the class: a defaulted comparison cannot compare the children of its own, unfinished type.
bool operator==(const Compound& a, const Compound& b) = default;

} // namespace mural::config
