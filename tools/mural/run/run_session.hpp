// Runs a program and its session from start to end. Passes events of the head to the program and vice versa.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/launch/environment.hpp"
#include "nodes/launch/private_display.hpp"
#include "nodes/launch/session_socket.hpp"
#include "nodes/launch/wall_window_manager.hpp"
#include "nodes/session/session_config.hpp"
#include "tools/mural/console.hpp"

namespace mural::cli {

constexpr int64_t kEndGraceMs = 3'000; // time for a program to end after the request

// Result of the preparations before the capture.
struct PreparedRun {
    SessionConfig config;   // complete
    std::string reportFile; // empty: none
    std::string page;       // address of the page in a browser (--page); empty: none
    std::string programPath;
    std::vector<std::string> program; // argv[0] is the user's spelling
    launch::Environment programEnvironment;
    launch::Environment headEnvironment;
    std::vector<std::string> headCommand;
    std::unique_ptr<launch::SessionSocket> socket;            // null: creation failed
    std::unique_ptr<launch::PrivateDisplay> display;          // null: the user's display
    std::unique_ptr<launch::WallWindowManager> windowManager; // null: no --size
};

// Writes the report in JSON if a file was requested.
void writeReport(const PreparedRun& run, const std::string& json, Console& console);

// Returns the exit status of `mural run`.
int runSession(PreparedRun& run, Console& console);

// Runs the program without head and capture. Counts frames and time (--native).
int runNative(PreparedRun& run, Console& console);

} // namespace mural::cli
