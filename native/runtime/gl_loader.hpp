// Loads GL commands by name.
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "common/base/result.hpp"
#include "nodes/gl/gl_platform.hpp"

namespace mural::native {

class GlLoader {
public:
    explicit GlLoader(std::function<gl::Proc(const char* name)> find) : find_(std::move(find)) {}

    // Sets the pointer to a command; null if the driver lacks it.
    template <class Call> void load(const char* name, Call& call) {
        call = reinterpret_cast<Call>(find_(name));
        if (!call && missing_.empty()) missing_ = name;
    }
    // Error: names the first missing command, and this requirement.
    [[nodiscard]] Result<void> result(const std::string& requirement) const {
        if (missing_.empty()) return {};
        return Error{"the GL driver lacks " + missing_ + "; " + requirement};
    }

private:
    std::function<gl::Proc(const char* name)> find_;
    std::string missing_;
};

} // namespace mural::native
