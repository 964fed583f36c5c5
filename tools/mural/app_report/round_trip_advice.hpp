// Advice for commands that cause round trips.
#pragma once

#include <string>
#include <string_view>

namespace mural::cli {

// Returns the way to avoid the round trips of a command of the report's `roundTripsBy`. Empty: none is known.
std::string roundTripAdvice(std::string_view command);

} // namespace mural::cli
