// Skips programs whose extensions few drivers have.
#pragma once

namespace programs {

// Prints one line and ends with status 77 if the current context lacks the extension. Tests interpret the status as
// "skipped".
void needExtension(const char* name);

} // namespace programs
