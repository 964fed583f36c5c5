// Levels, topics, destinations and cost of log lines.
#include "common/log/log.hpp"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>
#include <regex>
#include <thread>
#include <vector>

#include "common/log/process_log.hpp"
#include "tests/recorded_log.hpp"

namespace {
thread_local size_t allocations = 0;
}
[[gnu::noinline]] void* operator new(size_t bytes) {
    ++allocations;
    if (void* const memory = std::malloc(bytes)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace mural {
namespace {

using log::Level;
using log::Topic;

Level levelOf(const Result<log::Levels>& levels, Topic topic) { return levels.value()[static_cast<size_t>(topic)]; }

TEST(LogLevels, areInfoWithoutAnEntry) {
    const auto levels = log::parseLevels("");
    ASSERT_TRUE(levels);
    EXPECT_TRUE(std::ranges::all_of(levels.value(), [](Level level) { return level == Level::Info; }));
    EXPECT_EQ(log::currentLevels(), levels.value());
}

TEST(LogLevels, applyToOneTopicOrToAll) {
    const auto one = log::parseLevels("rsp:debug");
    ASSERT_TRUE(one);
    EXPECT_EQ(levelOf(one, Topic::Rsp), Level::Debug);
    EXPECT_EQ(levelOf(one, Topic::Output), Level::Info);
    const auto all = log::parseLevels("off");
    ASSERT_TRUE(all);
    EXPECT_TRUE(std::ranges::all_of(all.value(), [](Level level) { return level == Level::Off; }));
}

TEST(LogLevels, preferTheTopicInAnyOrder) {
    for (const char* text :
         {"warning,rsp:debug,output:trace", "rsp:debug, output:trace,warning", ",output:trace,,rsp:debug,warning,"}) {
        const auto levels = log::parseLevels(text);
        ASSERT_TRUE(levels) << text;
        EXPECT_EQ(levelOf(levels, Topic::Rsp), Level::Debug) << text;
        EXPECT_EQ(levelOf(levels, Topic::Output), Level::Trace) << text;
        EXPECT_EQ(levelOf(levels, Topic::Session), Level::Warning) << text;
    }
}

TEST(LogLevels, knowEveryNameOfTopicsAndLevels) {
    for (size_t topic = 0; topic < log::kTopics; ++topic)
        for (const Level level : {Level::Trace, Level::Debug, Level::Info, Level::Warning, Level::Error, Level::Off}) {
            const std::string text = std::string(nameOf(static_cast<Topic>(topic))) + ":" + std::string(nameOf(level));
            const auto levels = log::parseLevels(text);
            ASSERT_TRUE(levels) << text;
            EXPECT_EQ(levels.value()[topic], level) << text;
        }
}

TEST(LogLevels, rejectUnknownNamesWithOneLine) {
    for (const char* text :
         {"rps:debug", "rsp:loud", "loud", "rsp", "rsp:", ":debug", "debug:rsp", "rsp:debug:trace"}) {
        const auto levels = log::parseLevels(text);
        ASSERT_FALSE(levels) << text;
        const std::string& line = levels.error().message;
        for (const char* part : {"session", "rsp", "affinity", "error", "trace", "off"})
            EXPECT_NE(line.find(part), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos);
    }
    EXPECT_NE(log::parseLevels("rps:debug").error().message.find("topic \"rps\""), std::string::npos);
    EXPECT_NE(log::parseLevels("rsp:loud").error().message.find("level \"loud\""), std::string::npos);
}

TEST(LogLevels, comeFromTheEnvironment) {
    const log::Levels before = log::currentLevels();
    setenv("MURAL_LOG", "rsp:debug,off", 1);
    EXPECT_TRUE(log::start("test", "test: "));
    EXPECT_TRUE(log::enabled(Topic::Rsp, Level::Debug));
    EXPECT_FALSE(log::enabled(Topic::Rsp, Level::Trace));
    EXPECT_FALSE(log::enabled(Topic::Output, Level::Error));
    setenv("MURAL_LOG", "rps:debug", 1);
    const auto wrong = log::start("test", "test: ");
    ASSERT_FALSE(wrong);
    EXPECT_TRUE(wrong.error().message.starts_with("MURAL_LOG=rps:debug: ")) << wrong.error().message;
    unsetenv("MURAL_LOG");
    EXPECT_TRUE(log::start("mural", "mural: "));
    EXPECT_EQ(log::currentLevels(), before);
}

TEST(Log, joinsTextAndNumbers) {
    RecordedLog lines;
    const std::string name = "node";
    log::info(Topic::Node, name, ' ' + std::string("x"), " ", -5, " ", uint64_t{18446744073709551615u}, " ", size_t{7},
              " ", true, " ", 2.5, std::string_view("!"));
    EXPECT_EQ(lines.texts(), (std::vector<std::string>{"node x -5 18446744073709551615 7 1 2.50!"}));
}

TEST(Log, allocatesNothingForADisabledLine) {
    RecordedLog lines("off");
    const std::string text(100, 'x');
    const size_t before = allocations;
    for (int i = 0; i < 1000; ++i) {
        log::debug(Topic::Rsp, "datagram ", i, " of ", text);
        log::error(Topic::Rsp, "datagram ", i, " of ", text);
    }
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(lines.texts().empty());
}

// Lines for the user have neither time nor topic.
TEST(Log, printsLinesForTheUserAsTheyAre) {
    testing::internal::CaptureStderr();
    log::info(Topic::Session, "first {} %v");
    log::warning(Topic::Output, "second");
    log::error(Topic::Rsp, "third");
    log::debug(Topic::Rsp, "no line");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "mural: first {} %v\nmural: second\nmural: third\n");
}

TEST(Log, printsDiagnosticsWithTimeProcessTopicAndLevel) {
    const log::Levels before = log::currentLevels();
    log::setLevels(log::parseLevels("rsp:trace").value());
    log::setRole("node 3 %n");
    testing::internal::CaptureStderr();
    log::debug(Topic::Rsp, "member ", 2, " came {} %v");
    log::trace(Topic::Rsp, "more");
    log::debug(Topic::Output, "another topic");
    const std::string printed = testing::internal::GetCapturedStderr();
    log::setRole("mural");
    log::setLevels(before);
    const std::string stamp = R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z node 3 %n\[\d+\] rsp )";
    EXPECT_TRUE(
        std::regex_match(printed, std::regex(stamp + "debug: member 2 came \\{\\} %v\n" + stamp + "trace: more\n")))
        << printed;
}

TEST(Log, printsObjectsWithTheFormatJson) {
    setenv("MURAL_LOG_FORMAT", "yaml", 1);
    const auto wrong = log::start("test", "test: ");
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().message, "MURAL_LOG_FORMAT=yaml: expected text or json");
    setenv("MURAL_LOG_FORMAT", "json", 1);
    ASSERT_TRUE(log::start("node 3", "test: "));
    testing::internal::CaptureStderr();
    log::warning(Topic::Output, "\"quoted\" \\ tab\t %v {} \u00e4");
    const std::string printed = testing::internal::GetCapturedStderr();
    unsetenv("MURAL_LOG_FORMAT");
    ASSERT_TRUE(log::start("mural", "mural: "));
    const std::string same =
        std::regex_replace(printed, std::regex(R"re(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z|"pid":\d+)re"), "*");
    EXPECT_EQ(same, "{\"ts\":\"*\",\"level\":\"warning\",\"topic\":\"output\",\"process\":\"node 3\",*,"
                    "\"text\":\"\\\"quoted\\\" \\\\ tab\\u0009 %v {} \u00e4\"}\n");
}

TEST(Log, givesLinesToTheInnermostReceiver) {
    std::vector<std::string> outer, inner;
    const auto into = [](std::vector<std::string>& lines) {
        return [&lines](Topic topic, Level level, std::string_view text) {
            lines.push_back(std::string(nameOf(topic)) + " " + std::string(nameOf(level)) + " " + std::string(text));
            return true;
        };
    };
    const log::Receiver first(Level::Info, into(outer));
    {
        const log::Receiver second(Level::Warning, into(inner));
        log::info(Topic::Node, "a");
        log::warning(Topic::Node, "b");
    }
    log::error(Topic::Launch, "c");
    EXPECT_EQ(outer, (std::vector<std::string>{"node info a", "launch error c"}));
    EXPECT_EQ(inner, std::vector<std::string>{"node warning b"});
}

TEST(Log, showsLinesToObserversAsWell) {
    std::vector<std::string> taken, seen;
    const log::Receiver receiver(Level::Info, [&](Topic, Level, std::string_view text) {
        taken.emplace_back(text);
        return true;
    });
    {
        const log::Observer observer(Level::Warning, [&](Topic topic, Level level, std::string_view text) {
            seen.push_back(std::string(nameOf(topic)) + " " + std::string(nameOf(level)) + " " + std::string(text));
            log::warning(Topic::Tool, "not observed again");
        });
        log::info(Topic::Node, "too low");
        log::warning(Topic::Node, "one");
    }
    log::warning(Topic::Node, "two");
    EXPECT_EQ(seen, (std::vector<std::string>{"node warning one"}));
    EXPECT_EQ(std::ranges::count(taken, "one"), 1);
    EXPECT_EQ(taken.back(), "two");
}

TEST(Log, printsLinesThatTheReceiverCannotDeliver) {
    const log::Receiver broken(Level::Info, [](Topic, Level, std::string_view) { return false; });
    testing::internal::CaptureStderr();
    log::warning(Topic::Node, "the head is gone");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "mural: the head is gone\n");
}

TEST(Log, printsLinesOfTheReceiverItself) {
    int calls = 0;
    const log::Receiver receiver(Level::Info, [&](Topic, Level, std::string_view) {
        ++calls;
        log::warning(Topic::Transport, "the write takes long");
        return true;
    });
    testing::internal::CaptureStderr();
    log::info(Topic::Node, "a");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "mural: the write takes long\n");
    EXPECT_EQ(calls, 1);
}

// No line is lost while receivers come and go.
TEST(Log, isSafeFromSeveralThreads) {
    constexpr int kThreads = 4, kLines = 2000;
    std::atomic<int> received{0};
    RecordedLog rest;
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t)
        threads.emplace_back([t] {
            for (int i = 0; i < kLines; ++i) log::info(Topic::Node, "thread ", t, " line ", i);
        });
    for (int i = 0; i < 200; ++i) {
        const log::Receiver receiver(Level::Info, [&](Topic, Level, std::string_view) {
            ++received;
            return true;
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(received + static_cast<int>(rest.texts().size()), kThreads * kLines);
}

} // namespace
} // namespace mural
