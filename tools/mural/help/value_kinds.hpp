// How shells complete the values of options and arguments. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/mural/help/command_facts.hpp"

namespace mural::cli {

enum class ValueSource {
    Words,        // `words` alone
    Number,       // numbers, sizes, addresses: nothing to offer
    Text,         // text of the user: nothing to offer
    File,         // files whose names match `pattern`, or `words`
    Folder,       // folders
    Hosts,        // host names separated by commas, @NAME of daemons
    Command,      // a command of the shell
    Interface,    // network interfaces of this machine
    Session,      // running sessions
    ControlWords, // [SESSION] and the words of an operation
    Layout,       // layouts of the configuration file
    Canvas,       // canvases of the configuration file
    MuralCommand, // subcommands of mural
};

struct ValueKind {
    ValueSource source = ValueSource::Text;
    std::vector<std::string> words;
    std::string pattern; // of file names, such as *.eqc; empty: all
};

// Returns the kind of a value. Empty: value_kinds.cpp has no line for the option or the name of its value.
std::optional<ValueKind> valueKindOf(const std::string& command, const OptionFacts& option);

} // namespace mural::cli
