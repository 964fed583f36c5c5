#include <algorithm>
#include <functional>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "tools/mural/ctl/command_words.hpp"
#include "tools/mural/help/completion.hpp"
#include "tools/mural/help/man_page.hpp"
#include "tools/mural/help/value_kinds.hpp"
#include "tools/mural/run/run_options.hpp"

namespace mural::cli {
namespace {

using Words = std::vector<std::string>;

class FakeValues final : public LiveValues {
public:
    std::vector<Candidate> sessions() override { return {{"4711", "a session"}}; }
    std::vector<Candidate> controlWords(const Words& words, bool& takesFile) override {
        controlled = words;
        takesFile = !words.empty() && words.back() == "start";
        return {{"status", "state"}, {"stop", ""}};
    }
    std::vector<Candidate> daemons() override { return {{"@wall1", ""}, {"@wall2", ""}}; }
    std::vector<Candidate> interfaces() override { return {{"eth0", ""}}; }
    std::vector<Candidate> layouts(const std::string& file) override { return {{"layout of " + file, ""}}; }
    std::vector<Candidate> canvases(const std::string&) override { return {}; }

    Words controlled;
};

// A command line with the real options of `mural run`, and small commands of each kind.
class CompletionTest : public testing::Test {
protected:
    CompletionTest() {
        app_.formatter(std::make_shared<ProgramUsage>());
        CLI::App& run = *app_.add_subcommand("run", "run a program");
        run.prefix_command();
        describeRunOptions(run, run_);
        app_.add_subcommand("ctl", "request an operation")->add_option("COMMAND", words_, "words");
        app_.add_subcommand("stat", "show sessions")->add_option("session", text_, "a session");
        CLI::App& odd = *app_.add_subcommand("odd", "no kind");
        odd.add_option("--shape", text_, "a value that nobody described")->type_name("SHAPE");
        odd.add_option("--seconds", number_, "a time")->type_name("SECONDS")->check(CLI::Range(0.1, 600.0));
        app_.add_subcommand("hidden", "")->group("");
    }

    Completion complete(Words words) {
        words.insert(words.begin(), "mural");
        return completionOf(factsOf(app_), words, live_);
    }
    Words wordsAfter(const Words& words) {
        Words found;
        for (const Candidate& candidate : complete(words).candidates) found.push_back(candidate.word);
        return found;
    }

    // Usage lines are the business of main.cpp.
    class ProgramUsage : public CLI::Formatter {
        std::string make_usage(const CLI::App* app, std::string) const override {
            return "Usage: mural " + app->get_name() + (app->get_name() == "run" ? " -- PROGRAM\n" : "\n");
        }
    };

    CLI::App app_{"Mural: programs.", "mural"};
    RunArguments run_;
    Words words_;
    std::string text_;
    double number_ = 0;
    FakeValues live_;
};

TEST_F(CompletionTest, offersCommandsWithoutHiddenOnes) {
    EXPECT_EQ(wordsAfter({""}), (Words{"run", "ctl", "stat", "odd"}));
    EXPECT_EQ(wordsAfter({"st"}), Words{"stat"});
    EXPECT_TRUE(wordsAfter({"nothing", ""}).empty());
}

TEST_F(CompletionTest, offersEachOptionUntilItIsGiven) {
    EXPECT_EQ(wordsAfter({"run", "--ti"}), (Words{"--tiles", "--tile-queue", "--tiling"}));
    EXPECT_EQ(wordsAfter({"run", "--tiles", "2x2", "--ti"}), (Words{"--tile-queue", "--tiling"}));
    EXPECT_EQ(wordsAfter({"run", "--tiles=2x2", "--ti"}), (Words{"--tile-queue", "--tiling"}));
}

TEST_F(CompletionTest, offersValuesAlsoAfterAnEqualsSign) {
    EXPECT_EQ(wordsAfter({"run", "--tiling", ""}), (Words{"exact", "culled", "lean"}));
    EXPECT_EQ(wordsAfter({"run", "--tiling", "c"}), Words{"culled"});
    EXPECT_EQ(wordsAfter({"run", "--tiling=c"}), Words{"--tiling=culled"});
    EXPECT_TRUE(wordsAfter({"run", "--tiles", ""}).empty());
}

TEST_F(CompletionTest, leavesTheProgramToTheShell) {
    EXPECT_EQ(complete({"run", "--tiles", "2x2", "--", "glx"}).part, ShellPart::Program);
    EXPECT_EQ(complete({"run", "--tiles", "2x2", "--", "glx"}).programWord, 5u);
    EXPECT_EQ(complete({"run", "glxgears", "-"}).programWord, 2u);
    EXPECT_EQ(complete({"run", "glx"}).programWord, 2u);
    // A flag takes no word, so the next one begins the program.
    EXPECT_EQ(complete({"run", "--verify", "glx"}).programWord, 3u);
}

TEST_F(CompletionTest, completesTheLastHostOfAList) {
    EXPECT_EQ(complete({"run", "--nodes", "wall1,wa"}).part, ShellPart::Hosts);
    EXPECT_EQ(complete({"run", "--nodes", "wall1,wa"}).prefix, "wall1,");
    EXPECT_EQ(wordsAfter({"run", "--nodes=wall1,@"}), (Words{"--nodes=wall1,@wall1", "--nodes=wall1,@wall2"}));
}

TEST_F(CompletionTest, readsLayoutsFromTheConfigurationOfTheLine) {
    EXPECT_EQ(wordsAfter({"run", "--config", "wall.eqc", "--layout", ""}), Words{"layout of wall.eqc"});
    EXPECT_EQ(wordsAfter({"run", "--config=wall.eqc", "--layout", ""}), Words{"layout of wall.eqc"});
    EXPECT_EQ(complete({"run", "--config", ""}).pattern, "*.eqc");
}

TEST_F(CompletionTest, offersSessionsAndTheirOperations) {
    EXPECT_EQ(wordsAfter({"stat", ""}), Words{"4711"});
    EXPECT_EQ(wordsAfter({"ctl", ""}), (Words{"4711", "status", "stop"}));
    EXPECT_EQ(wordsAfter({"ctl", "4711", "sta"}), Words{"status"});
    EXPECT_EQ(live_.controlled, Words{"4711"});
    EXPECT_EQ(complete({"ctl", "record", "start", ""}).part, ShellPart::Files);
}

TEST_F(CompletionTest, reportsValuesWithoutAKind) {
    EXPECT_EQ(complete({"odd", "--shape", ""}).part, ShellPart::Undescribed);
    EXPECT_EQ(complete({"odd", "--seconds", ""}).part, ShellPart::None);
}

TEST_F(CompletionTest, offersOnlyValuesThatTheReadersAccept) {
    // --composition needs --db.
    const std::vector<std::pair<std::string, std::function<void(RunArguments&, const std::string&)>>> setters = {
        {"--display", [](RunArguments& a, const std::string& v) { a.display = v; }},
        {"--tiling", [](RunArguments& a, const std::string& v) { a.tiling = v; }},
        {"--local-rendering", [](RunArguments& a, const std::string& v) { a.localRendering = v; }},
        {"--delta", [](RunArguments& a, const std::string& v) { a.delta = v; }},
        {"--readback", [](RunArguments& a, const std::string& v) { a.readback = v; }},
        {"--gl", [](RunArguments& a, const std::string& v) { a.gl = v; }},
        {"--capture-via", [](RunArguments& a, const std::string& v) { a.captureVia = v; }},
        {"--balance", [](RunArguments& a, const std::string& v) { a.balance = v; }},
        {"--stereo", [](RunArguments& a, const std::string& v) { a.stereo = v; }},
        {"--overlay", [](RunArguments& a, const std::string& v) { a.overlay = v; }},
        {"--codec", [](RunArguments& a, const std::string& v) { a.codec = v; }},
        {"--stream", [](RunArguments& a, const std::string& v) { a.stream = v; }},
        {"--composition", [](RunArguments& a, const std::string& v) { a.composition = v, a.db = "2"; }}};
    for (const auto& [option, set] : setters) {
        const Words words = wordsAfter({"run", option, ""});
        EXPECT_GT(words.size(), 1u) << option;
        for (const std::string& word : words) {
            RunArguments arguments;
            arguments.program = {"glxgears"};
            set(arguments, word);
            const auto read = runOptionsFrom(arguments);
            EXPECT_TRUE(read.ok()) << option << " " << word;
        }
    }
}

TEST(NextWords, followTheUsageOfTheOperations) {
    const auto operations = nlohmann::json::parse(R"([
        {"name":"status","usage":"status","meaning":"state","arguments":[]},
        {"name":"record-start","usage":"record start FILE","meaning":"","arguments":[{"name":"file","kind":"file"}]},
        {"name":"record-stop","usage":"record stop","meaning":"","arguments":[]},
        {"name":"stop-node","usage":"stop-node NODE [force]","meaning":"",
         "arguments":[{"name":"node","kind":"whole number"},{"name":"force","kind":"truth value"}]}])");
    const auto wordsFor = [&](const Words& words) {
        Words found;
        for (const NextWord& next : nextWords(words, operations)) found.push_back(next.word + "/" + next.kind);
        return found;
    };
    EXPECT_EQ(wordsFor({}), (Words{"status/", "record/", "stop-node/"}));
    EXPECT_EQ(wordsFor({"record"}), (Words{"start/", "stop/"}));
    EXPECT_EQ(wordsFor({"record", "start"}), Words{"file/file"});
    EXPECT_EQ(wordsFor({"stop-node"}), Words{"node/whole number"});
    EXPECT_EQ(wordsFor({"stop-node", "1"}), Words{"force/"});
    EXPECT_TRUE(wordsFor({"status"}).empty());
    EXPECT_TRUE(nextWords({}, nlohmann::json()).empty());
}

TEST(ManPage, escapesRequestsAndDashes) {
    CommandFacts command;
    command.name = "try";
    command.meaning = "try a program";
    command.usage = "mural try [OPTIONS]";
    command.footer = "Examples:\n  mural try --fast\n  .dotted\n\n'quoted' words.\n.begins with a dot\nExit status: 0.";
    OptionFacts option;
    option.names = {"-f", "--fast"};
    option.value = "N";
    option.meaning = "a number\\word \xe2\x80\xa6";
    option.limits = "1 to 9";
    option.needs = {"--slow"};
    command.options = {option};
    const std::string page = manPage(command, {command}, "1.2.3", "2026-03-01");
    for (const char* part :
         {".TH MURAL\\-TRY 1 \"2026\\-03\\-01\" \"mural 1.2.3\" \"Mural\"", "mural\\-try \\- try a program",
          "\\fB\\-f\\fR, \\fB\\-\\-fast\\fR \\fIN\\fR", "A number\\(rsword ...", "Limits: 1 to 9.",
          "Requires \\fB\\-\\-slow\\fR.", "  mural try \\-\\-fast", "\\(aqquoted\\(aq words.", "\\&.begins with a dot",
          ".SH EXIT STATUS\n0.\n"})
        EXPECT_NE(page.find(part), std::string::npos) << part << "\n" << page;
}

} // namespace
} // namespace mural::cli
