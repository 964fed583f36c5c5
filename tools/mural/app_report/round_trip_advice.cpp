#include "tools/mural/app_report/round_trip_advice.hpp"

#include "streamcodec/command_table.hpp"
#include "streamcodec/command_traits.hpp"

namespace mural::cli {

std::string roundTripAdvice(std::string_view name) {
    const CommandInfo* command = findCommand(name);
    if (command == nullptr) return {};
    if (hasTrait(command->opcode, Trait::ReadsFramebuffer, Trait::Pixels))
        return "draw into a framebuffer object and use its texture; copies from the window need the pixels of all "
               "tiles";
    const std::string_view kind = command->commandClass;
    if (kind == "transfer")
        return "read into a pixel pack buffer and map it a frame or two later; map other buffers for writing only";
    if (kind == "query") return "ask for the result a frame later, or keep a copy of the data in the program";
    if (kind == "sync") return "omit it, or wait for earlier frames only; a swap already limits the frames in progress";
    return "use a result of an earlier frame";
}

} // namespace mural::cli
