#include "tools/mural/change/change_command.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "nodes/launch/program_check.hpp"
#include "nodes/session/plan_fields.hpp"
#include "tools/mural/ctl/session_request.hpp"

namespace mural::cli {

namespace {

constexpr const char* kChange = "change";

// Returns true if the command line has an option that divides the work. Without one, the options describe one node.
bool dividesWork(const CLI::App& app) {
    const auto options = app.get_options([](const CLI::Option* option) {
        const bool isOwn = option->check_lname("dry-run") || option->check_lname("undo") ||
                           option->check_lname("json") || option->check_lname("revert-after");
        return option->count() > 0 && !isOwn && !option->get_positional();
    });
    return !options.empty();
}

} // namespace

void describeChange(CLI::App& app, ChangeArguments& arguments) {
    arguments.app = &app;
    describePlanOptions(app, arguments.options);
    app.add_option("session", arguments.session, "name of a session, or pid of its mural run; default the only one")
        ->type_name("SESSION");
    app.add_flag("--dry-run", arguments.isDryRun, "only print the nodes that would start and end");
    app.add_flag("--undo", arguments.isUndo, "return to the options before the last change");
    app.add_option("--revert-after", arguments.revertAfterSeconds,
                   "revert the change after this time unless mural ctl keep comes first")
        ->type_name("SECONDS")
        ->check(CLI::Range(1, 3600));
    app.add_flag("--json", arguments.asJson, "print the reply of the session as one line of JSON");
}

int changeCommand(const ChangeArguments& arguments) {
    if (arguments.isUndo == dividesWork(*arguments.app))
        return requestFailure(kChange,
                              arguments.isUndo ? "--undo excludes other options (see mural change --help)"
                                               : "no option divides the work; give one, such as --tiles 2x2, or --undo "
                                                 "(see mural change --help)",
                              launch::kExitUsage);
    nlohmann::json request = nlohmann::json::object();
    if (arguments.isDryRun) request["dry-run"] = true;
    if (arguments.revertAfterSeconds > 0) {
        if (arguments.isUndo)
            return requestFailure(kChange, "--revert-after excludes --undo (see mural change --help)",
                                  launch::kExitUsage);
        request["revert-after"] = arguments.revertAfterSeconds;
    }
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
