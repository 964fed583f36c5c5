// Diagnostics of a configuration, one line each: "FILE:LINE:COLUMN: problem; remedy".
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

// A field that the file contains. Users of the file report fields without effect.
struct GivenField {
    std::string section; // keyword of the enclosing section; "attributes" for all attribute sections
    std::string field;
    SourcePosition at; // first occurrence
    int times = 0;
};

class Diagnostics {
public:
    // `strict` turns warnings about recoverable problems into errors.
    explicit Diagnostics(std::string file, bool strict = false) : file_(std::move(file)), strict_(strict) {}

    void warn(SourcePosition at, std::string what, std::string remedy);
    void error(SourcePosition at, std::string what, std::string remedy);
    void given(SourcePosition at, std::string_view section, std::string_view field);

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::vector<Diagnostic>& all() const { return all_; }
    [[nodiscard]] const std::vector<GivenField>& fieldsGiven() const { return given_; }
    [[nodiscard]] int errors() const { return errors_; }
    [[nodiscard]] std::string text(const Diagnostic& d) const;
    // Returns the first error, for callers with room for one line.
    [[nodiscard]] std::string firstError() const;

private:
    void add(Diagnostic d);

    std::string file_;
    bool strict_;
    int errors_ = 0;
    std::vector<Diagnostic> all_;
    std::vector<GivenField> given_; // in order of first occurrence
};

} // namespace mural::config
