#include "tools/mural/stat/prometheus_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/mural/stat/frame_summary.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;
using Labels = std::vector<std::pair<const char*, std::string>>;

struct Family {
    const char* name;
    const char* type;
    const char* help;
};

// In the order of the output.
constexpr Family kFamilies[] = {
    {"mural_frames_total", "counter", "Frames of the main window that all nodes have finished."},
    {"mural_frame_seconds", "gauge", "Mean time between two frames."},
    {"mural_stage_seconds", "gauge", "Mean time per frame of one stage, or of one wait, in one process."},
    {"mural_program_frames_total", "counter", "Frames of a program that all nodes have finished."},
    {"mural_program_sent_bytes_total", "counter", "Bytes of a program's stream, sent to each node."},
    {"mural_program_round_trips_total", "counter", "Requests whose reply the program waited for."},
    {"mural_program_wait_seconds_total", "counter", "Time that the threads of a program waited, by reason."},
    {"mural_node_up", "gauge", "1: the node is a member of the session."},
    {"mural_node_frames_total", "counter", "Frames that a node has finished."},
    {"mural_node_replay_cpu_seconds_total", "counter", "CPU time of a node's replay thread, without readback."},
    {"mural_node_readback_cpu_seconds_total", "counter", "CPU time of a node for readback and encoding of pictures."},
    {"mural_node_picture_bytes_total", "counter", "Encoded pictures of a node."},
    {"mural_node_joins_total", "counter", "Returns of a node after a loss."},
    {"mural_node_silent_seconds", "gauge", "Time since the node's last message."},
    {"mural_node_clock_error_seconds", "gauge", "Bound of the error of the node's estimated clock."},
    {"mural_output_age_seconds", "gauge", "Time since the node's last proof that its output is alive."},
};

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\' || c == '"') result += '\\';
        result += c == '\n' ? "\\n" : std::string(1, c);
    }
    return result;
}

// Collects samples by family, because each family must be printed as one block.
class Metrics {
public:
    void add(const char* name, const Labels& labels, double value) {
        std::string line = name;
        for (size_t i = 0; i < labels.size(); ++i)
            line += fmt::format("{}{}=\"{}\"", i == 0 ? "{" : ",", labels[i].first, escaped(labels[i].second));
        samples_[name] += fmt::format("{}}} {}\n", line, value);
    }

    [[nodiscard]] std::string text() const {
        std::string all;
        for (const Family& family : kFamilies) {
            const auto found = samples_.find(family.name);
            if (found == samples_.end()) continue;
            all += fmt::format("# HELP {0} {2}\n# TYPE {0} {1}\n{3}", family.name, family.type, family.help,
                               found->second);
        }
        return all;
    }

private:
    std::map<std::string, std::string> samples_; // by name
};

double numberOf(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_number() ? found->get<double>() : 0.0;
}

Json arrayOf(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_array() ? *found : Json::array();
}

std::string wholeText(const Json& object, const char* name) { return fmt::format("{:.0f}", numberOf(object, name)); }

void addProgram(Metrics& metrics, const std::string& session, const Json& program) {
    const Labels labels = {{"session", session}, {"program", wholeText(program, "client")}};
    metrics.add("mural_program_frames_total", labels, numberOf(program, "frames"));
    metrics.add("mural_program_sent_bytes_total", labels, numberOf(program, "bytes"));
    metrics.add("mural_program_round_trips_total", labels, numberOf(program, "roundTrips"));
    const Json waits = program.value("waitSeconds", Json::object());
    for (const auto& [reason, seconds] : waits.items()) {
        if (!seconds.is_number()) continue;
        Labels withReason = labels;
        withReason.emplace_back("reason", reason);
        metrics.add("mural_program_wait_seconds_total", withReason, seconds.get<double>());
    }
}

void addNode(Metrics& metrics, const std::string& session, const Json& node) {
    const Labels labels = {{"session", session}, {"node", wholeText(node, "node")}};
    metrics.add("mural_node_up", labels, node.value("state", "") == "alive" ? 1 : 0);
    metrics.add("mural_node_frames_total", labels, numberOf(node, "frames"));
    metrics.add("mural_node_replay_cpu_seconds_total", labels, numberOf(node, "replaySeconds"));
    metrics.add("mural_node_readback_cpu_seconds_total", labels, numberOf(node, "readbackSeconds"));
    metrics.add("mural_node_picture_bytes_total", labels, numberOf(node, "pictureBytes"));
    metrics.add("mural_node_joins_total", labels, numberOf(node, "joins"));
    metrics.add("mural_node_silent_seconds", labels, numberOf(node, "silentSeconds"));
}

void addStages(Metrics& metrics, const std::string& session, const FrameSummary& summary) {
    if (summary.frames < 2) return;
    metrics.add("mural_frame_seconds", {{"session", session}}, summary.frameMs / 1000);
    for (const auto& [process, means] : summary.stages)
        for (size_t i = 0; i < means.size(); ++i) {
            if (means[i] <= 0) continue;
            const bool isNode = process.first == SpanProcess::Node;
            Labels labels = {{"session", session}, {"process", isNode ? "node" : processName(process.first, 0)}};
            if (isNode) labels.emplace_back("node", std::to_string(process.second));
            labels.emplace_back("stage", std::string(nameOf(static_cast<SpanKind>(i))));
            metrics.add("mural_stage_seconds", labels, means[i] / 1000);
        }
}

} // namespace

std::string prometheusText(const std::vector<SessionFrames>& sessions) {
    Metrics metrics;
    for (const SessionFrames& frames : sessions) {
        const std::string session = frames.status.value("session", "");
        metrics.add("mural_frames_total", {{"session", session}}, numberOf(frames.status, "frames"));
        for (const Json& program : arrayOf(frames.status, "programs")) addProgram(metrics, session, program);
        for (const Json& node : arrayOf(frames.status, "nodes")) addNode(metrics, session, node);
        for (const Json& clock : frames.clocks)
            metrics.add("mural_node_clock_error_seconds", {{"session", session}, {"node", wholeText(clock, "node")}},
                        numberOf(clock, "errorNs") / 1e9);
        for (const Json& proof : arrayOf(frames.outputs, "nodes"))
            metrics.add("mural_output_age_seconds", {{"session", session}, {"node", wholeText(proof, "node")}},
                        numberOf(proof, "ageSeconds"));
        addStages(metrics, session, summarize(frames.frames));
    }
    return metrics.text();
}

} // namespace mural::cli
