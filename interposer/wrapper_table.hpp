// By index of GlFunctions: the wrapper of each command (null: the driver's own is handed out).
#pragma once

namespace mural {
void (*wrapperAt(int index))();
bool carriedAt(int index);
} // namespace mural
