// Sends the head's log lines for the user to `mural run`, which prints them.
#pragma once

#include <string>

#include "common/log/process_log.hpp"
#include "nodes/head/session/control_channel.hpp"

namespace mural {

class LogToControl {
public:
    explicit LogToControl(ControlChannel& control)
        : receiver_(log::Level::Info, [&control](log::Topic, log::Level, std::string_view text) {
              control.say(std::string(text));
              return true;
          }) {}

private:
    const log::Receiver receiver_;
};

} // namespace mural
