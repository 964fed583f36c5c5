// What is said of GL that goes past us. Notes go to `mural run` (MURAL_NOTES), which says each line once
// however many processes bring it; without it they go to the user's stderr.
#pragma once

namespace mural {

// One line for the user.
void sayBypass(const char* format, ...) __attribute__((format(printf, 1, 2)));

} // namespace mural
