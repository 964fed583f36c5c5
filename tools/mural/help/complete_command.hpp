// `mural complete`: prints the words by which a shell can continue a command line. The scripts of packaging/completion
// call it.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace mural::cli {

// words: the command line from "mural" on; the last word is completed. Prints one candidate per line,
// "WORD<TAB>MEANING". The last line begins with ':'. It names the part that the shell completes. Tabs separate its
// fields:
//   :none, :undescribed                  nothing
//   :files PREFIX PATTERN, :folders PREFIX, :hosts PREFIX, :command PREFIX
//   :program INDEX                       the program that begins at this word
int completeCommand(CLI::App& mural, const std::vector<std::string>& words);

} // namespace mural::cli
