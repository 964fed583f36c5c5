// What is wrong in a configuration, one line each: "FILE:LINE:COLUMN: what; remedy".
#pragma once

#include <string>
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

class Diagnostics {
public:
    // Strict: what could be understood all the same is an error, too.
    explicit Diagnostics(std::string file, bool strict = false) : file_(std::move(file)), strict_(strict) {}

    void warn(SourcePosition at, std::string what, std::string remedy);
    void error(SourcePosition at, std::string what, std::string remedy);

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::vector<Diagnostic>& all() const { return all_; }
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
};

} // namespace mural::config
