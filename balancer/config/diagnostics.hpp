// What is wrong in a configuration, one line each: "FILE:LINE:COLUMN: what; remedy".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "balancer/config/source_position.hpp"

namespace mural::config {

enum class Severity : uint8_t { Warning, Error };

struct Diagnostic {
    Severity severity = Severity::Warning;
    SourcePosition at;
    std::string what;
    std::string remedy;
};

// A field that the file gives, however often: for who uses the file, and knows what has no effect there.
struct GivenField {
    std::string section; // the word of the section around it: "attributes" for all of those
    std::string field;
    SourcePosition at;   // the first time
    int times = 0;
};

class Diagnostics {
public:
    // Strict: what could be understood all the same is an error, too.
    explicit Diagnostics(std::string file, bool strict = false) : file_(std::move(file)), strict_(strict) {}

    void warn(SourcePosition at, std::string what, std::string remedy);
    void error(SourcePosition at, std::string what, std::string remedy);
    void given(SourcePosition at, std::string_view section, std::string_view field);

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::vector<Diagnostic>& all() const { return all_; }
    [[nodiscard]] const std::vector<GivenField>& fieldsGiven() const { return given_; }
    [[nodiscard]] int errors() const { return errors_; }
    [[nodiscard]] std::string text(const Diagnostic& d) const;
    // Of the first error; what is asked for where only one line fits.
    [[nodiscard]] std::string firstError() const;

private:
    void add(Diagnostic d);

    std::string file_;
    bool strict_;
    int errors_ = 0;
    std::vector<Diagnostic> all_;
    std::vector<GivenField> given_; // by their first places
};

} // namespace mural::config
