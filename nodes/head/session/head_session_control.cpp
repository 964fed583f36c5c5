// The session's operations of the control interface (docs/reference/control.md). The control thread calls them.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/log/log.hpp"
#include "common/log/process_log.hpp"
#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/control/equalizer_operations.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/launch/session_socket.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

Json levelsJson() {
    const log::Levels levels = log::currentLevels();
    Json byTopic = Json::object();
    for (size_t i = 0; i < log::kTopics; ++i)
        byTopic[std::string(nameOf(static_cast<log::Topic>(i)))] = nameOf(levels[i]);
    return {{"levels", byTopic}};
}

// Nodes keep their levels: each is a process of its own, with a MURAL_LOG of its own.
Result<Json> changeLevels(const Json& arguments) {
    if (const auto text = arguments.find("levels"); text != arguments.end()) {
        const auto levels = log::parseLevels(text->get<std::string>());
        if (!levels) return levels.error();
        log::setLevels(levels.value());
    }
    return levelsJson();
}

Result<Json> resultOf(const Result<void>& done) {
    if (!done) return done.error();
    return Json::object();
}

} // namespace

void HeadSession::announce(const Json& event) {
    control_.send(event);
    feed_.publish(ControlTopic::Events, event);
}

// A session without its socket still runs: the line names the consequence.
void HeadSession::openControl() {
    if (config_.socketPath.empty()) return;
    ControlServerConfig server;
    server.path = launch::controlSocketOf(config_.socketPath);
    server.hello = {
        {"mural", MURAL_VERSION}, {"session", config_.session}, {"runPid", getppid()}, {"headPid", getpid()}};
    auto started = ControlServer::start(std::move(server), controlOperations(), feed_);
    if (started)
        controlServer_ = std::move(*started);
    else
        log::warning(log::Topic::Session, started.error().message);
}

void HeadSession::openPreview() {
    if (config_.socketPath.empty() || !output_) return;
    PreviewServer::OnWanted onWanted;
    if (config_.display == Display::Windows)
        onWanted = [this](uint32_t width, uint32_t height) {
            nodes_.scheduleSoon(wire::HeadCommand::WantPreview, bytesOf(windowPictures_.begin(width, height)));
        };
    auto started = PreviewServer::start(
        launch::pictureSocketOf(config_.socketPath), [this](int node) { return areaOnWall(node); },
        std::move(onWanted));
    if (started)
        preview_ = std::move(*started);
    else
        log::warning(log::Topic::Session, started.error().message);
}

std::optional<Viewport> HeadSession::areaOnWall(int node) const {
    const auto stage = plans_.current();
    if (node < 0 || static_cast<size_t>(node) >= stage->plan.nodes.size()) return std::nullopt;
    const NodePlan& plan = stage->plan.nodes[static_cast<size_t>(node)];
    if (plan.isVacant || plan.canvas != 0) return std::nullopt;
    if (plan.shown) return plan.shown;
    if (plan.area) return plan.area;
    const double columns = stage->config.columns, rows = stage->config.rows;
    return Viewport{plan.region.column / columns, plan.region.row / rows, plan.region.columns / columns,
                    plan.region.rows / rows};
}

ControlOperations HeadSession::controlOperations() {
    ControlOperations all;
    all.add({"status", "", "the state of programs and nodes, as mural stat shows it", {}, [this](const Json&) {
                 return Result<Json>(statusOf(status()));
             }});
    all.add({"report", "", "the numbers of the session up to now", {}, [this](const Json&) {
                 return Result<Json>(reportOf(numbers()));
             }});
    all.add({"log-level",
             "",
             "the levels of the head's log lines; with LEVELS it changes them, as MURAL_LOG does",
             {{"levels", Kind::Text, false, "comma-separated list of [topic:]level"}},
             changeLevels});
    all.add({"stop", "", "end the programs and the session in order", {}, [this](const Json&) {
                 log::info(log::Topic::Session, "the session ends at the request of mural ctl stop");
                 announce({{"event", "stop-requested"}});
                 return Result<Json>(Json::object());
             }});
    all.add({"program-window",
             "",
             "the program whose picture the wall shows, its X display, and its window there",
             {},
             [this](const Json&) { return programWindow(); }});
    addNodeOperations(all);
    addStopOperations(all);
    addChangeOperations(all);
    addPlanOperations(all);
    addOverlayOperation(all);
    addFramesOperation(all);
    addOutputsOperation(all);
    addEqualizerOperations(all, equalizers_); // a later plan may have equalizers
    return all;
}

Result<Json> HeadSession::programWindow() {
    const auto program = shownProgram();
    if (!program) return program.error();
    return Json{{"client", program->client},
                {"pid", program->pid != 0 ? Json(program->pid) : Json()},
                {"display", program->display},
                {"window", program->window}};
}

void HeadSession::addNodeOperations(ControlOperations& operations) {
    operations.add({"nodes", "", "the state of each node", {}, [this](const Json&) {
                        return Result<Json>(Json{{"nodes", statusOf(status())["nodes"]}});
                    }});
    operations.add(nodeOperation("restart-node", "end a node and start it again; it joins with the current state",
                                 false, [this](int node, bool) { return restartNode(node); }));
    operations.add(nodeOperation("remove-node", "end a node for good; other nodes take its tiles or chunks", true,
                                 [this](int node, bool isForced) { return removeNode(node, isForced); }));
}

ControlOperation HeadSession::nodeOperation(std::string name, std::string meaning, bool canForce,
                                            std::function<Result<void>(int node, bool isForced)> change) {
    ControlOperation operation;
    operation.name = std::move(name);
    operation.meaning = std::move(meaning);
    operation.arguments = {{"node", Kind::Whole, true, "number of the node, from 0"}};
    if (canForce)
        operation.arguments.push_back(
            {"force", Kind::Truth, false, "also if no other node takes its part of the picture"});
    operation.perform = [this, change = std::move(change)](const Json& arguments) -> Result<Json> {
        const auto number = arguments.at("node").get<int64_t>();
        if (const auto known = checkNode(number); !known) return known.error();
        return resultOf(change(static_cast<int>(number), arguments.value("force", false)));
    };
    return operation;
}

Result<void> HeadSession::checkNode(int64_t node) {
    if (node < 0 || node >= nodeCount())
        return Error{"the session has no node " + std::to_string(node) + "; its nodes are 0 to " +
                     std::to_string(nodeCount() - 1)};
    const auto plan = currentPlan(); // without the nodes of a change in progress
    if (static_cast<size_t>(node) >= plan->nodes.size() || plan->nodes[static_cast<size_t>(node)].isVacant)
        return Error{"node " + std::to_string(node) + " is no node of the current plan; see mural ctl nodes"};
    if (finishing_) return Error{"the session is ending; its nodes end with it"};
    return {};
}

Result<void> HeadSession::restartNode(int node) {
    NodeConnection& link = nodes_.link(node);
    if (const auto can = returns_->canRestart(node); !can)
        return Error{link.describe() + " cannot be restarted: " + can.error().message};
    link.lose("an operator restarts it");
    return {};
}

Result<void> HeadSession::removeNode(int node, bool isForced) {
    NodeConnection& link = nodes_.link(node);
    const std::string subject = link.describe() + " cannot be removed: ";
    if (!hasOtherMembers(node))
        return Error{subject + "it is the only node that draws at the moment; end the session with mural ctl stop"};
    const auto plan = plans_.nodePlan(node);
    const bool isReplaced = plan->movesArea || plan->movesRange;
    if (!isReplaced && !isForced)
        return Error{subject + "no other node takes its part of the picture; add force, or use --balance"};
    if (const auto retired = returns_->retire(node); !retired) return Error{subject + retired.error().message};
    link.lose("an operator removes it");
    return {};
}

} // namespace mural
