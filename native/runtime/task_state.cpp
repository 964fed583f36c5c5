#include "native/runtime/task_state.hpp"

#include <utility>

namespace mural::native {

void TaskState::apply() {
    if (beforeApply) std::exchange(beforeApply, nullptr)();
    target.apply(part.drawnWhole, part.scissor);
}

} // namespace mural::native
