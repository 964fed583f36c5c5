// The operations that clients of the control interface can request, by name (docs/reference/control.md).
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural {

struct ControlArgument {
    // File: text; mural ctl completes a relative path. Scalar: text, number or truth value.
    enum class Kind { Whole, Text, Truth, File, Scalar, Object };
    std::string name;
    Kind kind = Kind::Text;
    bool isRequired = true;
    std::string meaning;
};

struct ControlOperation {
    std::string name;
    // Words of `mural ctl`: "equalizer NAME set PARAMETER VALUE". Capitals name an argument, brackets mark an optional
    // one. Empty: the name, followed by the arguments.
    std::string usage;
    std::string meaning; // for `help`
    std::vector<ControlArgument> arguments;
    // Called with an object whose members have been checked. Returns an object. An error is one line for the user.
    std::function<Result<nlohmann::json>(const nlohmann::json& arguments)> perform;
};

// Words that name the kind of an error in replies. They never change.
namespace control_code {
inline constexpr const char* kBadRequest = "bad-request";             // not a valid request
inline constexpr const char* kUnknownOperation = "unknown-operation"; // no such operation
inline constexpr const char* kBadArgument = "bad-argument";           // missing, unknown, or of another type
inline constexpr const char* kFailed = "failed";                      // the operation is not possible now
inline constexpr const char* kLimit = "limit";                        // the client exceeds a limit
} // namespace control_code

// An error of an operation: its code, and one line for the user.
struct ControlError {
    std::string code; // empty: no error
    std::string text;
};

// Not thread-safe. perform() calls the handlers in the calling thread.
class ControlOperations {
public:
    void add(ControlOperation operation);
    [[nodiscard]] bool contains(const std::string& name) const { return byName_.contains(name); }
    [[nodiscard]] std::vector<std::string> names() const;

    // Checks the arguments, performs the operation and stores its result.
    ControlError perform(const std::string& name, const nlohmann::json& arguments, nlohmann::json& result) const;

    // Appends the description of each operation to an array: name, usage, meaning, arguments.
    void describe(nlohmann::json& list) const;

private:
    std::map<std::string, ControlOperation> byName_;
};

// Returns the error for a name that is none of `names`. It names the nearest ones.
ControlError unknownOperation(const std::string& name, const std::vector<std::string>& names);

} // namespace mural
