#include "tools/mural/accuracy/progress.hpp"

#include "common/log/log.hpp"
#include "tools/mural/child_runs/interruption.hpp"

namespace mural::cli {

void reportProgress(const std::string& what) {
    if (Interruption::signal() == 0) log::info(log::Topic::Tool, what);
}

} // namespace mural::cli
