// A program and its session, from start to end: the head, the program, what each says of the other.
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

constexpr int64_t kEndGraceMs = 3'000; // of a program that is asked to end

// All that has been found out before anything is captured.
struct PreparedRun {
    SessionConfig config; // complete
    std::string reportFile; // empty: none
    std::string programPath;
    std::vector<std::string> program; // with argv[0] as the user wrote it
    launch::Environment programEnvironment;
    launch::Environment headEnvironment;
    std::vector<std::string> headCommand;
    std::unique_ptr<launch::SessionSocket> socket;            // null: it could not be made
    std::unique_ptr<launch::PrivateDisplay> display;          // null: the user's own
    std::unique_ptr<launch::WallWindowManager> windowManager; // null: no --size
};

// The report for programs, when there is a file for it.
void writeReport(const PreparedRun& run, const std::string& json, Console& console);

// Returns the exit status of `mural run`.
int runSession(PreparedRun& run, Console& console);

// Without head and capture: counts frames and time (--native).
int runNative(PreparedRun& run, Console& console);

} // namespace mural::cli
