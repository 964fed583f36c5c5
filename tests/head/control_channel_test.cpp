// The lines of the control connection: split reads, a slow reader, invalid text.
#include "common/json/json_text.hpp"
#include "nodes/head/session/control_channel.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <thread>

#include "common/log/log.hpp"
#include "nodes/head/session/log_to_control.hpp"

namespace mural {
namespace {

struct Ends {
    Ends() {
        int fds[2];
        EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, fds), 0);
        mine = FileDescriptor(fds[0]);
        head = std::make_unique<ControlChannel>(FileDescriptor(fds[1]));
    }
    FileDescriptor mine;
    std::unique_ptr<ControlChannel> head;
};

TEST(ControlChannel, reassemblesLines) {
    Ends ends;
    ASSERT_EQ(send(ends.mine.get(), "one\ntw", 6, 0), 6);
    EXPECT_EQ(ends.head->receive(Deadline::inMs(5000)), "one");
    EXPECT_EQ(ends.head->receive(Deadline::inMs(1)), std::nullopt);
    ASSERT_EQ(send(ends.mine.get(), "o\n", 2, 0), 2);
    EXPECT_EQ(ends.head->receive(Deadline::inMs(5000)), "two");
    EXPECT_FALSE(ends.head->broken());
    ends.mine = FileDescriptor();
    EXPECT_EQ(ends.head->receive(Deadline::inMs(5000)), std::nullopt);
    EXPECT_TRUE(ends.head->broken());
    ends.head->say("nobody hears this");
}

TEST(ControlChannel, losesNothingAndBlocksNothingWhileTheReaderPauses) {
    Ends ends;
    constexpr int kLines = 5000; // more than a socket buffers
    for (int i = 0; i < kLines; ++i) ends.head->send({{"line", i}});
    EXPECT_FALSE(ends.head->broken());
    std::thread ending([&] { ends.head.reset(); }); // writes the rest while it is read
    std::string all;
    char bytes[4096];
    for (ssize_t n = 0; (n = recv(ends.mine.get(), bytes, sizeof(bytes), 0)) > 0;)
        all.append(bytes, static_cast<size_t>(n));
    ending.join();
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), kLines);
    EXPECT_NE(all.find("{\"line\":" + std::to_string(kLines - 1) + "}\n"), std::string::npos);
}

TEST(ControlChannel, writesJsonForInvalidText) {
    Ends ends;
    ends.head->say("bad \xff\xfe \"text\"\nand more");
    char bytes[256];
    const ssize_t n = recv(ends.mine.get(), bytes, sizeof(bytes), 0);
    const std::string line(bytes, static_cast<size_t>(n));
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
    EXPECT_TRUE(parseJson(line)["text"].is_string());
}

// Lines for the user arrive once, in order, between the head's other events; disabled lines and diagnostics do not.
TEST(LogToControl, sendsLinesForTheUser) {
    Ends ends;
    const log::Levels before = log::currentLevels();
    log::setLevels(log::parseLevels("output:warning").value());
    {
        const LogToControl lines(*ends.head);
        log::warning(log::Topic::Node, "node ", 1, " was lost");
        ends.head->send({{"event", "frame"}});
        log::info(log::Topic::Output, "disabled");
        log::debug(log::Topic::Node, "a diagnostic");
        log::info(log::Topic::Node, "node ", 1, " is back");
    }
    log::setLevels(before);
    ends.head.reset();
    std::string all;
    char bytes[4096];
    for (ssize_t n = 0; (n = recv(ends.mine.get(), bytes, sizeof(bytes), 0)) > 0;)
        all.append(bytes, static_cast<size_t>(n));
    EXPECT_EQ(all, "{\"event\":\"say\",\"text\":\"node 1 was lost\"}\n{\"event\":\"frame\"}\n"
                   "{\"event\":\"say\",\"text\":\"node 1 is back\"}\n");
}

} // namespace
} // namespace mural
