// The pointer of the program's display: its place in the program's window, and its shape (XFIXES). A thread of its own
// asks the X server, while somebody watches.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "nodes/input/program_display.hpp"

namespace mural::page {

struct CursorState {
    double x = 0, y = 0;               // fractions of the program's window, from the upper left corner
    double displayX = 0, displayY = 0; // the same of the display
    bool isInside = false;
    int hotX = 0, hotY = 0, width = 0, height = 0; // pixels of the shape
    std::shared_ptr<const std::string> shape;      // PNG; null: the display has no XFIXES

    bool operator==(const CursorState&) const = default; // compares shapes by their address
};

class CursorWatch {
public:
    // onChange: called by the thread.
    explicit CursorWatch(std::function<void(const CursorState& state)> onChange);
    CursorWatch(const CursorWatch&) = delete;
    CursorWatch& operator=(const CursorWatch&) = delete;
    ~CursorWatch();

    // nullopt: nobody watches.
    void watch(std::optional<input::ProgramDisplay> display);

private:
    struct Eye;
    void work();

    const std::function<void(const CursorState& state)> onChange_;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::optional<input::ProgramDisplay> wanted_;
    int openFd_ = -1; // of the connection; -1: none
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural::page
