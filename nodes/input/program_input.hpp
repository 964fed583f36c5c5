// Input of viewers for the program, on a thread of its own. Used by the thread of the page's io_context.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "nodes/input/display_input.hpp"

namespace mural::input {

class ProgramInput {
public:
    static constexpr size_t kMaxWaiting = 1024; // events; further ones are dropped

    // onSent: called by the input's thread after the X server has an event of this viewer.
    explicit ProgramInput(std::function<void(int viewer, uint32_t number)> onSent);
    ProgramInput(const ProgramInput&) = delete;
    ProgramInput& operator=(const ProgramInput&) = delete;
    ~ProgramInput();

    // Sends to this display from now on. Keys that are held on the earlier one are released there.
    void use(const ProgramDisplay& display);
    [[nodiscard]] bool hasDisplay() const { return current_.has_value(); }
    // Returns false if the event was dropped.
    bool send(int viewer, const InputEvent& event);
    // Releases all held keys and buttons, after the events that wait.
    void releaseAll();
    [[nodiscard]] bool holdsButtons() const { return holdsButtons_; }
    // Returns the error of the last attempt to open the display, or why the latest event was dropped; empty: none.
    [[nodiscard]] std::string problem() const;

private:
    struct Entry {
        int viewer = 0; // 0: the display changes
        InputEvent event;
        std::optional<ProgramDisplay> display;
    };

    bool add(Entry entry);
    void work();
    void perform(std::unique_ptr<DisplayInput>& input, const Entry& entry);

    const std::function<void(int viewer, uint32_t number)> onSent_;
    std::optional<ProgramDisplay> current_;
    std::atomic<bool> holdsButtons_{false};
    mutable std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::deque<Entry> queue_;
    std::string problem_;
    int openFd_ = -1; // of the display's connection; -1: none
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural::input
