// Manual pages in the roff of man(7). Pure.
#pragma once

#include <string>
#include <vector>

#include "tools/mural/help/command_facts.hpp"

namespace mural::cli {

// "mural", "mural-run": without section.
std::string manPageName(const CommandFacts& command);

// Returns mural(1) for mural itself, and the page of the command for others.
// date: of the build, such as 2026-03-01; empty: none.
std::string manPage(const CommandFacts& command, const std::vector<CommandFacts>& all, const std::string& version,
                    const std::string& date);

} // namespace mural::cli
