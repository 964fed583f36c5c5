// Programs of what few drivers have.
#pragma once

namespace programs {

// Where the current context lacks the extension: one line that says so, and the end with status 77, which tests take for
// "skipped".
void needExtension(const char* name);

} // namespace programs
