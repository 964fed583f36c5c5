// Requests that a program draws its window again: by an Expose event, as after the end of a window that covered it.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

// displayName empty: DISPLAY. A window that is gone is no error; if another one has its id by now, that one is drawn
// again, which is harmless. Errors: no connection to the display in time.
Result<void> requestRedraw(const std::string& displayName, uint32_t window, Deadline deadline);

} // namespace mural
