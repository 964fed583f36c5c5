#include "tools/mural/help/complete_command.hpp"

#include <fmt/format.h>

#include "tools/mural/help/live_values.hpp"

namespace mural::cli {

namespace {

std::string partLine(const Completion& completion) {
    switch (completion.part) {
    case ShellPart::None: break;
    case ShellPart::Files: return fmt::format(":files\t{}\t{}", completion.prefix, completion.pattern);
    case ShellPart::Folders: return fmt::format(":folders\t{}", completion.prefix);
    case ShellPart::Hosts: return fmt::format(":hosts\t{}", completion.prefix);
    case ShellPart::Command: return fmt::format(":command\t{}", completion.prefix);
    case ShellPart::Undescribed: return ":undescribed";
    case ShellPart::Program: return fmt::format(":program\t{}", completion.programWord);
    }
    return ":none";
}

} // namespace

int completeCommand(CLI::App& mural, const std::vector<std::string>& words) {
    MachineValues live;
    const Completion completion = completionOf(factsOf(mural), words, live);
    for (const Candidate& candidate : completion.candidates) fmt::print("{}\t{}\n", candidate.word, candidate.meaning);
    fmt::print("{}\n", partLine(completion));
    return 0;
}

} // namespace mural::cli
