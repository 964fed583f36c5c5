// The wrapper of each command, by index of GlFunctions; null: use the driver's own.
#pragma once

namespace mural {
void (*wrapperAt(int index))();
bool carriedAt(int index);
} // namespace mural
