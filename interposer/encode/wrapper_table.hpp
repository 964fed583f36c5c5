// The table of wrappers, with the indices of GlFunctions. Null: the driver's own function is used.
#pragma once

namespace mural {
void (*wrapperAt(int index))();
bool isSupportedAt(int index);
} // namespace mural
