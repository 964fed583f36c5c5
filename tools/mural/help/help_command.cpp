#include "tools/mural/help/help_command.hpp"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include "nodes/launch/program_check.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/help/man_page.hpp"

namespace mural::cli {

const char* const kHelpFooter =
    "Examples:\n  mural help run                 the same as mural run --help\n  mural help --man man1          the "
    "manual pages of all commands, as files of this folder\n\nSOURCE_DATE_EPOCH (seconds since 1970) is the date of "
    "the pages.\nExit status: 0, 1 if a page cannot be written, 2 for an unknown command.";

namespace {

constexpr int kExitNotWritten = 1;

// Returns the date of SOURCE_DATE_EPOCH; empty: it is not set, so that equal builds have equal pages.
std::string dateOfSources() {
    const char* text = std::getenv("SOURCE_DATE_EPOCH");
    if (text == nullptr) return {};
    std::time_t seconds = 0;
    const auto [end, error] = std::from_chars(text, text + std::strlen(text), seconds);
    if (error != std::errc() || *end != 0) return {};
    return fmt::format("{:%Y-%m-%d}", fmt::gmtime(seconds));
}

int writePages(CLI::App& mural, const std::string& folder) {
    namespace fs = std::filesystem;
    std::error_code failed;
    fs::create_directories(folder, failed);
    const std::vector<CommandFacts> commands = factsOf(mural);
    for (const CommandFacts& command : commands) {
        if (command.isHidden) continue;
        const std::string path = (fs::path(folder) / (manPageName(command) + ".1")).string();
        errno = 0;
        std::ofstream file(path, std::ios::binary | std::ios::trunc);
        file << manPage(command, commands, muralVersion(), dateOfSources());
        file.close();
        if (file) continue;
        fmt::print(stderr, "mural help: {} cannot be written: {}; choose another folder\n", path, std::strerror(errno));
        return kExitNotWritten;
    }
    return 0;
}

} // namespace

void describeHelp(CLI::App& help, HelpArguments& a) {
    help.add_option("COMMAND", a.command, "the command to describe; default mural itself");
    help.add_option("--man", a.manFolder, "write the manual pages of all commands into this folder")->type_name("DIR");
}

int helpCommand(CLI::App& mural, const HelpArguments& a) {
    if (!a.manFolder.empty()) return writePages(mural, a.manFolder);
    if (a.command.empty()) {
        fmt::print("{}", mural.help());
        return 0;
    }
    for (CLI::App* command : mural.get_subcommands([](CLI::App*) { return true; })) {
        if (command->get_name() != a.command) continue;
        fmt::print("{}", command->help());
        return 0;
    }
    fmt::print(stderr, "mural help: unknown command {}; mural --help lists all commands\n", a.command);
    return launch::kExitUsage;
}

} // namespace mural::cli
