#include "tools/mural/app_report/division_facts.hpp"

#include <fmt/format.h>

#include "tools/mural/console.hpp"

namespace mural::cli {

namespace {

// Moves are announced, and taken at the next complete clear, so some frames must pass.
constexpr int64_t kFramesForMoves = 30;

std::string reasonsText(const AppRun& run) {
    std::map<std::string, int64_t> reasons;
    const auto by = run.report.is_object() ? run.report.find("uncomparedFramesBy") : run.report.end();
    if (run.report.is_object() && by != run.report.end() && by->is_object())
        for (const auto& [reason, count] : by->items())
            if (count.is_number()) reasons[reason] = count.get<int64_t>();
    return countsText(reasons);
}

nlohmann::json comparisonJson(const AppRun& run) {
    return {{"frames", run.number("verifiedFrames")},
            {"pixels", run.number("verifiedPixels")},
            {"differing", run.number("differingPixels")},
            {"largestDifference", run.number("largestDifference")},
            {"uncomparedFrames", run.number("uncomparedFrames")}};
}

void addTiles(const AppMeasured& m, Section& s) {
    if (m.tiles.frames() == 0) return;
    s.add("tiles", "tiles", comparisonJson(m.tiles), comparisonText(m.tiles), "--tiles CxR");
    const std::string whole = limitOf(m.tiles, "drawn-whole");
    s.add("drawnWhole", "each node draws only its part", whole.empty(), whole.empty() ? "yes" : "no: " + whole);
}

void addMoves(const AppMeasured& m, Section& s) {
    if (!m.balance.performed() || m.balance.frames() == 0) {
        if (m.tiles.frames() > 0)
            s.add("tilesMove", "tiles can move", nullptr,
                  "unknown: " + (m.balance.performed() ? "no frame was captured" : m.balance.skipped));
        return;
    }
    const std::string stay = limitOf(m.balance, "areas-stay");
    if (stay.empty() && m.balance.frames() < kFramesForMoves)
        s.add("tilesMove", "tiles can move", nullptr, fmt::format("unknown: {} frames are too few", m.balance.frames()),
              "a larger --seconds");
    else
        s.add("tilesMove", "tiles can move", stay.empty(), stay.empty() ? "yes" : "no: " + stay,
              stay.empty() ? "--balance auto or --tile-queue 128x128" : "--tiles, without --balance");
}

void addSharing(const AppMeasured& m, Section& s) {
    if (m.tiles.frames() == 0) return;
    const double part = sharedPart(m);
    if (part < 0) {
        s.add("sharedDraws", "draws can be shared", nullptr,
              "unknown: " + (m.db.performed() ? "no frame was captured" : m.db.skipped));
        return;
    }
    const std::string limit = limitOf(m.db, "draws-unshared");
    std::string text = part == 0 ? "no" : fmt::format("in {:.0f} % of the frames", part * 100);
    if (part == 0) text += limit.empty() ? ": no draw of the captured frames can be shared" : ": " + limit;
    s.add("sharedDraws", "draws can be shared", part, text, part > 0 ? "--db N" : "--tiles instead of --db");
    s.add("db", "pictures of shared draws", comparisonJson(m.db), comparisonText(m.db));
}

} // namespace

std::string limitOf(const AppRun& run, const char* code) {
    if (!run.report.is_object()) return {};
    const auto limits = run.report.find("limits");
    if (limits == run.report.end() || !limits->is_array()) return {};
    for (const auto& limit : *limits)
        if (limit.is_object() && limit.value("code", "") == code) return limit.value("text", "");
    return {};
}

bool tilesMove(const AppMeasured& m) {
    return m.balance.performed() && m.balance.frames() >= kFramesForMoves && limitOf(m.balance, "areas-stay").empty() &&
           limitOf(m.tiles, "drawn-whole").empty();
}

double sharedPart(const AppMeasured& m) {
    if (!m.db.performed() || !m.db.report.is_object()) return -1;
    const auto draws = m.db.report.find("sharedDraws");
    if (draws == m.db.report.end() || !draws->is_object()) return -1;
    const double frames = draws->value("frames", 0.0);
    return frames > 0 ? draws->value("shared", 0.0) / frames : -1;
}

std::string comparisonText(const AppRun& run) {
    const double pixels = run.number("verifiedPixels"), differing = run.number("differingPixels");
    std::string text = pixels == 0 ? std::string("no frame was compared")
                                   : fmt::format("{:.0f} of {:.0f} pixels in {:.0f} frames differ", differing, pixels,
                                                 run.number("verifiedFrames"));
    if (differing > 0) text += fmt::format(", largest difference {:.0f} of 255", run.number("largestDifference"));
    if (const double left = run.number("uncomparedFrames"); left > 0)
        text += fmt::format("; {:.0f} frame{} not compared ({})", left, left == 1 ? "" : "s", reasonsText(run));
    return text;
}

Section divisionFacts(const AppMeasured& m) {
    Section s{"divisions", "Ways to divide the work", {}};
    addTiles(m, s);
    if (m.trace.frames > 0) {
        const double part = static_cast<double>(m.trace.clearedFrames) / static_cast<double>(m.trace.frames);
        s.add("clearedFrames", "frames with a clear of the colours", part, fmt::format("{:.0f} %", part * 100));
    }
    addMoves(m, s);
    addSharing(m, s);
    return s;
}

} // namespace mural::cli
