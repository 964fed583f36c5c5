// Input of wall windows and remote walls for the program. Thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <sys/types.h>

#include "common/base/result.hpp"
#include "nodes/head/input/shown_program.hpp"
#include "nodes/input/input_permission.hpp"
#include "nodes/input/program_input.hpp"

namespace mural {

class WallInput {
public:
    // find: returns the program, or the reason against input. Called by the threads of take(). runPid: of `mural run`.
    WallInput(std::function<Result<ShownProgram>()> find, pid_t runPid)
        : find_(std::move(find)), runPid_(runPid), input_([](int, uint32_t) {}) {}

    // Sends an event to the program, if the permission includes the program's display. The first reason against it is
    // reported. source: the sender of the event, such as "remote wall museum". option: permits Any.
    struct Source {
        std::string name;
        std::string option;
        input::InputPermission permission = input::InputPermission::Off;
    };
    void take(const Source& source, const input::InputEvent& event);
    // Releases what the events hold down.
    void releaseAll();

private:
    void findDisplay(int64_t nowNs);                                                           // requires mutex_
    void report(const Source& source, const input::InputEvent& event, const std::string& why); // requires mutex_

    const std::function<Result<ShownProgram>()> find_;
    const pid_t runPid_;
    std::mutex mutex_; // guards the members below
    input::ProgramInput input_;
    bool isPrivate_ = false; // the display
    int64_t foundNs_ = 0;    // the latest search; 0: none
    std::string problem_;    // of the latest search
    std::string reported_;
};

} // namespace mural
