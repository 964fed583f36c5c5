// Operations of the control interface that change the running session (docs/reference/control.md). The control thread
// calls them.
#include <nlohmann/json.hpp>

#include "common/log/log.hpp"
#include "nodes/head/session/head_session.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

constexpr int64_t kRecordPatienceMs = 8'000; // below the patience of mural ctl

} // namespace

void HeadSession::addChangeOperations(ControlOperations& operations) {
    operations.add({"latency",
                    "",
                    "the number of frames that programs may be ahead; with FRAMES it changes the number",
                    {{"frames", Kind::Whole, false, "0 to " + std::to_string(kMaxLatency)}},
                    [this](const Json& arguments) { return changeLatency(arguments); }});
    operations.add({"record-start",
                    "record start FILE",
                    "record the programs' GL streams from the next frame on, for mural replay",
                    {{"file", Kind::File, true, "trace; an existing file is replaced"}},
                    [this](const Json& arguments) { return startRecording(arguments); }});
    operations.add({"record-stop", "record stop", "end the recording and complete its file", {}, [this](const Json&) {
                        return stopRecording();
                    }});
}

Result<Json> HeadSession::startRecording(const Json& arguments) {
    const auto file = arguments.at("file").get<std::string>();
    const std::string subject = "trace " + file + " cannot begin: ";
    if (file.empty()) return Error{"the name of the trace is empty; choose a file, such as app.mural"};
    if (finishing_) return Error{subject + "the session is ending"};
    if (!fetchesCopies_)
        return Error{subject + "with one node, programs do not send the pixels that they copy from windows; start the "
                               "session with --record, or with two nodes"};
    if (!nodes_.hasRejoinLog())
        return Error{subject + "the session keeps no state of its programs; start it with --restart-nodes 1 or more"};
    if (!nodes_.canJoin())
        return Error{subject + "programs have sent more than the " + std::to_string(config_.cacheBytes >> 20) +
                     " MiB of the rejoin log; start the session with a larger --cache-size"};
    const auto begun = recording_.start(file, aboutTrace(), Deadline::inMs(kRecordPatienceMs));
    if (!begun) return begun.error();
    return recordingJson(begun.value());
}

Result<Json> HeadSession::stopRecording() {
    const auto ended = recording_.stop(Deadline::inMs(kRecordPatienceMs));
    if (!ended) return ended.error();
    return recordingJson(ended.value());
}

Result<Json> HeadSession::changeLatency(const Json& arguments) {
    if (const auto frames = arguments.find("frames"); frames != arguments.end()) {
        const auto wanted = frames->get<int64_t>();
        if (wanted < 0 || wanted > kMaxLatency)
            return Error{"a latency of " + std::to_string(wanted) + " frames is not possible; choose 0 to " +
                         std::to_string(kMaxLatency)};
        if (finishing_) return Error{"the session is ending; its latency does not change any more"};
        log::info(log::Topic::Session, "the latency changes from ", programs_->latency(), " to ", wanted,
                  " frames at the request of mural ctl latency");
        programs_->setLatency(static_cast<uint32_t>(wanted));
    }
    return Json{{"latency", programs_->latency()}};
}

} // namespace mural
