#include "tools/mural/stat/session_rates.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tools/mural/console.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

double number(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_number() ? found->get<double>() : 0.0;
}
std::string memberText(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}
const Json& part(const Json& object, const char* name) {
    static const Json kNone = Json::object();
    const auto found = object.find(name);
    return found != object.end() ? *found : kNone;
}

// Ignores entries that are not objects.
std::vector<Json> entries(const Json& object, const char* name) {
    std::vector<Json> result;
    const Json& list = part(object, name);
    if (!list.is_array()) return result;
    std::copy_if(list.begin(), list.end(), std::back_inserter(result),
                 [](const Json& entry) { return entry.is_object(); });
    return result;
}

const Json* find(const std::vector<Json>& list, const char* key, const Json& value) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const Json& entry) { return part(entry, key) == value; });
    return found == list.end() ? nullptr : &*found;
}

Json programRates(const Json& before, const Json& now, double seconds) {
    const auto grown = [&](const char* name) { return number(now, name) - number(before, name); };
    const double frames = grown("frames");
    Json rates = {{"framesPerSecond", frames / seconds}};
    if (frames > 0) {
        rates["callsPerFrame"] = grown("calls") / frames;
        rates["bytesPerFrame"] = grown("bytes") / frames;
        rates["roundTripsPerFrame"] = grown("roundTrips") / frames;
    }
    Json shares = Json::object();
    for (const auto& [what, total] : part(now, "waitSeconds").items()) {
        if (total.is_number())
            shares[what] = (total.get<double>() - number(part(before, "waitSeconds"), what.c_str())) / seconds;
    }
    rates["waitShares"] = shares;
    return rates;
}

Json nodeRates(const Json& before, const Json& now, double seconds) {
    const auto work = [](const Json& node) { return number(node, "replaySeconds") + number(node, "readbackSeconds"); };
    return {{"busyShare", (work(now) - work(before)) / seconds}};
}

// Rates over all programs, per frame of the wall.
Json deltaRates(const Json& before, const Json& now, double frames) {
    Json rates = Json::object();
    for (const char* name : {"records", "rawBytes", "stagedBytes", "wireBytes", "pageHits", "newPages", "patches",
                             "encodeSeconds", "programBytes", "deferredRecords", "droppedRecords", "droppedBytes"})
        rates[std::string(name) + "PerFrame"] = (number(now, name) - number(before, name)) / frames;
    return rates;
}

void addRates(const Json& before, Json& now, const char* list, const char* key, double seconds,
              Json (*rates)(const Json&, const Json&, double)) {
    const std::vector<Json> then = entries(before, list);
    std::vector<Json> entriesNow = entries(now, list);
    for (Json& entry : entriesNow) {
        const Json* same = find(then, key, part(entry, key));
        if (same != nullptr && seconds > 0) entry["recent"] = rates(*same, entry, seconds);
    }
    now[list] = entriesNow;
}

// Describes a program's waits, longest first: "waits 61 % for the nodes' frames".
std::string waitText(const Json& program) {
    static constexpr std::pair<const char*, const char*> kWords[] = {
        {"frames", "for the nodes to finish frames"},
        {"space", "for buffer space: the nodes are behind"},
        {"reply", "for replies to round trips"},
        {"window", "for its window to show the picture"}};
    const Json& shares = part(part(program, "recent"), "waitShares");
    const char* what = nullptr;
    double maximum = 0.005;
    for (const auto& [name, words] : kWords) {
        if (number(shares, name) <= maximum) continue;
        maximum = number(shares, name);
        what = words;
    }
    std::string nodes;
    for (const Json& node : part(program, "waitsForNodes"))
        if (node.is_number_integer()) nodes += fmt::format("{}{}", nodes.empty() ? "" : ", ", node.get<int>());
    if (!nodes.empty()) nodes = ", now for node " + nodes;
    return (what == nullptr ? "does not wait"
                            : fmt::format("waits {:.0f} % of the time {}", 100 * std::min(maximum, 1.0), what)) +
           nodes;
}

std::string tripsText(const Json& program) {
    const Json& recent = part(program, "recent");
    const double all = number(program, "roundTrips");
    const std::string line =
        recent.contains("roundTripsPerFrame")
            ? fmt::format("{:.2f} round trips per frame, {:.0f} in all", number(recent, "roundTripsPerFrame"), all)
            : fmt::format("{:.0f} round trip{} in all", all, all == 1 ? "" : "s");
    std::map<std::string, int64_t> counts;
    for (const auto& [command, count] : part(program, "roundTripsBy").items())
        if (count.is_number()) counts[command] = count.get<int64_t>();
    const std::string by = countsText(counts);
    return by.empty() ? line : line + ": " + by;
}

void addProgram(const Json& program, std::vector<std::string>& lines) {
    const Json& recent = part(program, "recent");
    lines.push_back(fmt::format("  program {:.0f}  {}", number(program, "pid"), memberText(program, "command")));
    std::string line = fmt::format("    {:.0f} frames", number(program, "frames"));
    if (recent.contains("framesPerSecond")) line += fmt::format(", {:.1f} frames/s", number(recent, "framesPerSecond"));
    if (recent.contains("callsPerFrame"))
        line += fmt::format(", {:.0f} calls and {} per frame", number(recent, "callsPerFrame"),
                            sizeText(number(recent, "bytesPerFrame")));
    lines.push_back(line);
    lines.push_back("    " + tripsText(program));
    lines.push_back("    " + waitText(program));
}

void addDelta(const Json& delta, std::vector<std::string>& lines) {
    const Json& recent = part(delta, "recent");
    if (!recent.contains("rawBytesPerFrame")) return;
    const double pages = number(recent, "pageHitsPerFrame") + number(recent, "newPagesPerFrame");
    lines.push_back(fmt::format("  delta    {} per frame, {} of it new to the nodes, {} compressed; {:.1f} of {:.1f} "
                                "pages per frame cached, encoding {:.0f} us",
                                sizeText(number(recent, "rawBytesPerFrame")),
                                sizeText(number(recent, "stagedBytesPerFrame")),
                                sizeText(number(recent, "wireBytesPerFrame")), number(recent, "pageHitsPerFrame"),
                                pages, 1e6 * number(recent, "encodeSecondsPerFrame")));
    if (number(delta, "deferredRecords") + number(delta, "droppedRecords") > 0)
        lines.push_back(fmt::format(
            "  filter   {} per frame, {} of it dropped ({:.1f} records); {} deferred now",
            sizeText(number(recent, "programBytesPerFrame")), sizeText(number(recent, "droppedBytesPerFrame")),
            number(recent, "droppedRecordsPerFrame"), sizeText(number(delta, "deferredBytes"))));
}

void addEqualizer(const Json& equalizer, std::vector<std::string>& lines) {
    const bool isFrozen = equalizer.value("frozen", false);
    const std::string decision = isFrozen ? "frozen" : memberText(equalizer, "decision");
    if (memberText(equalizer, "divides") == "zoom") {
        lines.push_back(fmt::format("  equalizer \"{}\"  zoom {:.2f}; changed after {:.0f} of {:.0f} frames; {}",
                                    memberText(equalizer, "name"), number(equalizer, "zoom"),
                                    number(equalizer, "moves"), number(equalizer, "frames"), decision));
        return;
    }
    std::string nodes;
    for (const Json& node : entries(equalizer, "nodes"))
        nodes += fmt::format("{}node {:.0f} {:.0f} %", nodes.empty() ? "" : ", ", number(node, "node"),
                             100 * number(node, "part"));
    lines.push_back(fmt::format("  equalizer \"{}\"  {}: {}; moved after {:.0f} of {:.0f} frames; busy {:.0f} % of the "
                                "longest time; {}",
                                memberText(equalizer, "name"), memberText(equalizer, "divides"), nodes,
                                number(equalizer, "moves"), number(equalizer, "frames"),
                                100 * number(equalizer, "efficiency"), decision));
}

void addNode(const Json& node, std::vector<std::string>& lines) {
    std::string state = memberText(node, "state");
    if (state == "alive") {
        state = fmt::format("{:.0f} frames", number(node, "frames"));
        if (node.contains("recent"))
            state += fmt::format(", busy {:.0f} %", 100 * number(part(node, "recent"), "busyShare"));
        if (const double frames = number(node, "frames"); frames > 0 && number(node, "pictureRawBytes") > 0)
            state += fmt::format(", pictures of {} compressed to {} per frame",
                                 sizeText(number(node, "pictureRawBytes") / frames),
                                 sizeText(number(node, "pictureBytes") / frames));
        if (number(node, "joins") > 0)
            state += fmt::format(", rejoined {:.0f} time{}, the last time in {:.1f} s with {}", number(node, "joins"),
                                 number(node, "joins") == 1 ? "" : "s", number(node, "secondsToRejoin"),
                                 sizeText(number(node, "snapshotBytes")));
        if (number(node, "silentSeconds") > 5)
            state += fmt::format(", no message for {:.0f} s", number(node, "silentSeconds"));
    }
    const std::string stream = memberText(node, "stream");
    const std::string by = stream.empty() || stream == "memory" ? "" : ", by " + stream;
    lines.push_back(fmt::format("  node {:.0f}  {}{}, pid {:.0f}, {}: {}", number(node, "node"),
                                memberText(node, "where"), by, number(node, "pid"), memberText(node, "gl"), state));
}

} // namespace

std::vector<Json> withRates(const std::vector<Json>& before, std::vector<Json> now) {
    for (Json& session : now) {
        const auto then = std::find_if(before.begin(), before.end(),
                                       [&](const Json& s) { return part(s, "session") == part(session, "session"); });
        if (then == before.end()) continue;
        const double seconds = number(session, "atSeconds") - number(*then, "atSeconds");
        addRates(*then, session, "programs", "client", seconds, programRates);
        const double frames = number(session, "frames") - number(*then, "frames");
        if (session.contains("delta") && session["delta"].is_object() && frames > 0)
            session["delta"]["recent"] = deltaRates(part(*then, "delta"), part(session, "delta"), frames);
        addRates(*then, session, "nodes", "node", seconds, nodeRates);
    }
    return now;
}

std::vector<std::string> nodeLines(const Json& session) {
    std::vector<std::string> lines;
    for (const Json& node : entries(session, "nodes")) addNode(node, lines);
    return lines;
}

std::vector<std::string> statLines(const Json& session) {
    std::vector<std::string> lines;
    lines.push_back(
        fmt::format("session {:.0f}  {} tiles, display {}, latency {:.0f}, {:.0f} frames on the wall; head {:.0f}",
                    number(session, "runPid"), memberText(session, "tiles"), memberText(session, "display"),
                    number(session, "latency"), number(session, "frames"), number(session, "headPid")));
    const std::vector<Json> programs = entries(session, "programs");
    for (const Json& program : programs) addProgram(program, lines);
    if (programs.empty()) lines.emplace_back("  no program draws at the moment");
    addDelta(part(session, "delta"), lines);
    for (const Json& e : entries(session, "equalizers")) addEqualizer(e, lines);
    for (const Json& node : entries(session, "nodes")) addNode(node, lines);
    return lines;
}

} // namespace mural::cli
