#include "tools/mural/change/change_command.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "nodes/launch/program_check.hpp"
#include "nodes/session/plan_fields.hpp"
#include "tools/mural/ctl/session_request.hpp"

namespace mural::cli {

namespace {

constexpr const char* kChange = "change";

} // namespace

void describeChange(CLI::App& app, ChangeArguments& arguments) {
    describePlanOptions(app, arguments.options);
    app.add_option("session", arguments.session, "name of a session, or pid of its mural run; default the only one")
        ->type_name("SESSION");
    app.add_flag("--dry-run", arguments.isDryRun, "only print the nodes that would start and end");
    app.add_flag("--undo", arguments.isUndo, "return to the options before the last change");
    app.add_flag("--json", arguments.asJson, "print the reply of the session as one line of JSON");
}

int changeCommand(const ChangeArguments& arguments) {
    nlohmann::json request = nlohmann::json::object();
    if (arguments.isDryRun) request["dry-run"] = true;
    if (!arguments.isUndo) {
        RunArguments options = arguments.options;
        options.program = {"unused"}; // the session has its program
        const auto parsed = runOptionsFrom(options);
        if (!parsed)
            return requestFailure(kChange, parsed.error().message + " (see mural change --help)", launch::kExitUsage);
        request["options"] = planFieldsOf(parsed.value().config);
    }
    const std::string operation = arguments.isUndo ? "undo" : "plan";
    const Deadline deadline = Deadline::inMs(kReplyPatienceMs);
    int status = 0;
    auto client = connectToSession(kChange, arguments.session, deadline, status);
    if (!client) return requestFailure(kChange, client.error().message, status);
    const auto reply = client->request(operation, request, deadline);
    if (!reply) return requestFailure(kChange, reply.error().message, kExitFailed);
    return printReply(kChange, operation, reply.value(), arguments.asJson);
}

} // namespace mural::cli
