#include "tools/mural/run/slurm_allocation.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <unistd.h>

#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/console.hpp"

namespace mural::cli {

std::vector<std::string> sallocCommandOf(const std::string& mural, std::vector<std::string> arguments,
                                         const std::vector<std::string>& program, const std::string& options) {
    // --kill-command: SIGTERM ends a run in order when its job is cancelled.
    std::vector<std::string> command{"salloc", "--job-name=mural", "--kill-command=TERM"};
    for (const std::string& word : launch::wordsOf(options)) command.push_back(word);
    command.push_back(mural);
    arguments.resize(arguments.size() - std::min(arguments.size(), program.size()));
    if (!arguments.empty() && arguments.back() == "--") arguments.pop_back();
    bool isValue = false;
    for (const std::string& word : arguments) {
        const bool isOption = word == "--slurm" || word.starts_with("--slurm=");
        if (!isValue && !isOption) command.push_back(word);
        isValue = isOption && word == "--slurm";
    }
    command.emplace_back("--");
    command.insert(command.end(), program.begin(), program.end());
    return command;
}

int becomeSalloc(const std::vector<std::string>& command) {
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execvp(words.front(), words.data());
    Console(true).error(std::string("--slurm: salloc cannot be executed: ") + std::strerror(errno) +
                        "; install the commands of Slurm, or name the hosts with --nodes");
    return launch::kExitUsage;
}

} // namespace mural::cli
