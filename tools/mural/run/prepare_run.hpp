// Prepares runs and replays before a session starts: names, displays, and checks of outputs.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "tools/mural/run/run_options.hpp"
#include "tools/mural/run/run_session.hpp"

namespace mural::cli {

// Returns a name that other processes can't guess. It fits into an abstract socket's name.
std::string newSessionName();

// Creates the session's socket in the file system, for programs in other network namespaces. On failure these programs
// are not captured, and the run continues.
void createSessionSocket(PreparedRun& run);

// Checks --out as far as possible before the first picture. The head opens the output.
Result<void> checkOutput(const std::string& out);
// Returns a message about earlier pictures that stay in the folder next to the new ones. Empty: there are none.
std::string earlierPictures(const std::string& out);

// Checks whether an option's file can be written, because that may happen much later. Creates no file. An empty path is
// none.
Result<void> checkResultFile(const std::string& option, const std::string& file);

// Selects the displays of the program and the wall. Starts a private display if the wall or the program needs one.
Result<void> chooseDisplay(const RunOptions& options, bool programNeedsOne, PreparedRun& run);
// Returns a message about pictures that --display app does not show. Requires chooseDisplay(). Empty: there are none.
std::string unseenPictures(const RunOptions& options, const PreparedRun& run);

} // namespace mural::cli
