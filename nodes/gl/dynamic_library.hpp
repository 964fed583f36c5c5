// A library loaded at run time, so that a machine without EGL, OSMesa or X can use the others. GL libraries are never
// unloaded: they leave thread-local storage and exit handlers behind.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/base/result.hpp"

namespace mural::gl {

class DynamicLibrary {
public:
    // Opens the first of `names` that the loader finds. package: named in the error message.
    static Result<DynamicLibrary> open(const std::vector<std::string>& names, const std::string& package);

    [[nodiscard]] void* symbol(const char* name) const;

    // Sets `function` to the symbol. Returns false if the library lacks it.
    template <class Function> bool load(Function& function, const char* name) const {
        function = reinterpret_cast<Function>(symbol(name));
        return function != nullptr;
    }

    [[nodiscard]] const std::string& name() const { return name_; }

private:
    DynamicLibrary(void* handle, std::string name) : handle_(handle), name_(std::move(name)) {}

    void* handle_;
    std::string name_;
};

} // namespace mural::gl
