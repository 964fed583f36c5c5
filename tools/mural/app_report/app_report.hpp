// The result of `mural app-report`: a verdict, and facts in sections. Text, JSON and HTML show the same facts.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace mural::cli {

enum class Verdict { Exact, Differences, Alone, NotCapturable };

// "works, exact", "works, with differences", "runs alone", "not capturable".
const char* nameOf(Verdict verdict);
// The exit status of mural app-report: 0, 1, 2, 2.
int exitStatusOf(Verdict verdict);

struct Fact {
    std::string key; // in JSON
    std::string label;
    nlohmann::json value;
    std::string text;
    std::string advice; // next step; empty: none
};

struct Section {
    std::string key, title;
    std::vector<Fact> facts;

    void add(std::string factKey, std::string label, nlohmann::json value, std::string text, std::string advice = {}) {
        facts.push_back({std::move(factKey), std::move(label), std::move(value), std::move(text), std::move(advice)});
    }
};

struct AppReport {
    std::vector<std::string> program; // with its arguments
    Verdict verdict = Verdict::NotCapturable;
    std::string sentence;    // reason of the verdict
    std::string recommended; // command line; empty: none
    std::vector<Section> sections;
    nlohmann::json runs = nlohmann::json::array(); // output and report of each run
    std::string nativePicture, wallPicture;        // PNG files; empty: none
};

} // namespace mural::cli
