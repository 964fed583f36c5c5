// What runs and replays find out before a session starts.
#pragma once

#include <string>

#include "common/result.hpp"
#include "tools/mural/run_options.hpp"
#include "tools/mural/run_session.hpp"

namespace mural::cli {

// Names are guessed by nobody else and fit into an abstract socket's.
std::string newSessionName();

// The session's socket in the file system, for programs in other network namespaces; without it they are not captured,
// and the run goes on.
void createSessionSocket(PreparedRun& run);

// What can be said about --out before the first picture; the head opens it.
Result<void> checkOutput(const std::string& out);
// Of pictures that stay in its folder from before, beside those that come; empty: there are none.
std::string earlierPictures(const std::string& out);

// Whether a file can be written there, which may be long after: --report is, when all is over. No file is made.
Result<void> checkReport(const std::string& file);

// Which display the program and the wall get; starts a private one where the wall needs it, or the program does.
Result<void> chooseDisplay(const RunOptions& options, bool programNeedsOne, PreparedRun& run);
// What --display app does not show, once the displays are chosen; empty: nothing.
std::string unseenPictures(const RunOptions& options, const PreparedRun& run);

} // namespace mural::cli
