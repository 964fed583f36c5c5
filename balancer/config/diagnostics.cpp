#include "balancer/config/diagnostics.hpp"

#include <algorithm>

namespace mural::config {

namespace {

// Most diagnostics kept. A file of another format has an error in every word.
constexpr size_t kMaxLines = 200;

} // namespace

void Diagnostics::add(Diagnostic d) {
    if (d.severity == Severity::Error) ++errors_;
    if (all_.size() < kMaxLines) all_.push_back(std::move(d));
    // the first error is always kept
    else if (d.severity == Severity::Error && errors_ == 1)
        all_.back() = std::move(d);
}

void Diagnostics::warn(SourcePosition at, std::string what, std::string remedy) {
    add({strict_ ? Severity::Error : Severity::Warning, at, std::move(what), std::move(remedy)});
}

void Diagnostics::error(SourcePosition at, std::string what, std::string remedy) {
    add({Severity::Error, at, std::move(what), std::move(remedy)});
}

void Diagnostics::given(SourcePosition at, std::string_view section, std::string_view field) {
    const auto same =
        std::ranges::find_if(given_, [&](const GivenField& g) { return g.section == section && g.field == field; });
    if (same != given_.end())
        ++same->times;
    else
        given_.push_back({std::string(section), std::string(field), at, 1}); // bounded by the vocabulary of the format
}

std::string Diagnostics::text(const Diagnostic& d) const {
    std::string where = file_;
    if (d.at.line > 0) where += ":" + std::to_string(d.at.line) + ":" + std::to_string(d.at.column);
    return where + ": " + d.what + (d.remedy.empty() ? "" : "; " + d.remedy);
}

std::string Diagnostics::firstError() const {
    for (const Diagnostic& d : all_) {
        if (d.severity == Severity::Error) return text(d);
    }
    return {};
}

} // namespace mural::config
