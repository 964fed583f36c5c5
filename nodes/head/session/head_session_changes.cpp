// Operations of the control interface that change the running session (docs/reference/control.md). The control thread
// calls them.
#include <nlohmann/json.hpp>

#include "common/log/log.hpp"
#include "nodes/head/session/head_session.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

} // namespace

void HeadSession::addChangeOperations(ControlOperations& operations) {
    operations.add({"latency",
                    "",
                    "the number of frames that programs may be ahead; with FRAMES it changes the number",
                    {{"frames", Kind::Whole, false, "0 to " + std::to_string(kMaxLatency)}},
                    [this](const Json& arguments) { return changeLatency(arguments); }});
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
