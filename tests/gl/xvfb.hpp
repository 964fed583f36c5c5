// An X server of the test, with a display number that the server selects.
#pragma once

#include <string>

#include <sys/types.h>

#include "common/base/result.hpp"

namespace mural::test {

class Xvfb {
public:
    Xvfb() = default;
    Xvfb(const Xvfb&) = delete;
    Xvfb& operator=(const Xvfb&) = delete;
    ~Xvfb();

    // Waits until it answers, and sets DISPLAY of this process.
    Result<void> start();
    [[nodiscard]] const std::string& display() const { return display_; }

private:
    pid_t process_ = -1;
    std::string display_;
};

} // namespace mural::test
