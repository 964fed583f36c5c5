// The control socket: its mode, many clients, clients that flood, stop reading or vanish.
#include "common/json/json_text.hpp"
#include "nodes/head/control/control_server.hpp"

#include <atomic>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "common/log/log.hpp"
#include "tests/control/sample_operations.hpp"
#include "tests/temporary_folder.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr int64_t kPatienceMs = 20'000;
constexpr const char* kStatus = "{\"id\":1,\"op\":\"status\"}\n";

class TestClient {
public:
    explicit TestClient(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        EXPECT_EQ(connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }
    // Returns the number of bytes that the socket accepted.
    size_t write(const std::string& bytes, int flags = 0) {
        const ssize_t n = send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | flags);
        return n > 0 ? static_cast<size_t>(n) : 0;
    }
    // Returns the next line; null after the end of the connection.
    Json read() {
        const Deadline deadline = Deadline::inMs(kPatienceMs);
        while (!deadline.passed()) {
            if (const size_t end = received_.find('\n'); end != std::string::npos) {
                const Json line = parseJson(received_.substr(0, end));
                received_.erase(0, end + 1);
                return line;
            }
            char part[65536];
            pollfd ready{socket_.get(), POLLIN, 0};
            if (poll(&ready, 1, 100) <= 0) continue;
            const ssize_t n = recv(socket_.get(), part, sizeof part, 0);
            if (n <= 0) return {};
            received_.append(part, static_cast<size_t>(n));
        }
        ADD_FAILURE() << "no line in time";
        return {};
    }
    Json request(const std::string& line) {
        write(line);
        return read();
    }
    void endInput() { shutdown(socket_.get(), SHUT_WR); }

private:
    FileDescriptor socket_;
    std::string received_;
};

class ControlServerTest : public ::testing::Test {
protected:
    void start(int64_t stallMs = kPatienceMs) {
        ControlServerConfig config;
        config.path = path;
        config.hello = {{"session", "mural-1-0"}};
        config.stallMs = stallMs;
        ControlOperations operations = sampleOperations();
        operations.add({"count", "", "", {}, [this](const Json&) { return Result<Json>(Json{{"count", ++count}}); }});
        operations.add({"log", "", "", {}, [](const Json&) {
                            log::info(log::Topic::Session, "performed");
                            return Result<Json>(Json::object());
                        }});
        auto started = ControlServer::start(std::move(config), std::move(operations), feed);
        ASSERT_TRUE(started.ok()) << started.error().message;
        server = std::move(*started);
    }

    test::TemporaryFolder folder;
    const std::string path = folder.at("control");
    ControlFeed feed;
    std::atomic<int> count{0};
    std::unique_ptr<ControlServer> server;
};

TEST_F(ControlServerTest, opensASocketOfItsUserOnly) {
    const mode_t before = umask(0);
    start();
    umask(before);
    struct stat facts {};
    ASSERT_EQ(stat(path.c_str(), &facts), 0);
    EXPECT_TRUE(S_ISSOCK(facts.st_mode));
    EXPECT_EQ(facts.st_mode & 0777, 0600U);
    server.reset();
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(ControlServerTest, reportsAPathThatCannotBeUsed) {
    ControlServerConfig config;
    for (const std::string& bad : {folder.at("none/control"), folder.at(std::string(200, 'x')), std::string()}) {
        config.path = bad;
        const auto started = ControlServer::start(config, sampleOperations(), feed);
        ASSERT_FALSE(started.ok()) << bad;
        EXPECT_EQ(started.error().message.find('\n'), std::string::npos);
    }
}

TEST_F(ControlServerTest, greetsAndReplies) {
    start();
    TestClient client(path);
    EXPECT_EQ(client.read(), parseJson(R"({"hello":{"protocol":1,"session":"mural-1-0"}})"));
    EXPECT_EQ(client.request(kStatus)["result"]["frames"], 7);
}

TEST_F(ControlServerTest, repliesAfterTheEndOfTheInput) {
    start();
    TestClient client(path);
    client.write(std::string(kStatus) + kStatus);
    client.endInput();
    EXPECT_TRUE(client.read().contains("hello"));
    for (int i = 0; i < 2; ++i) EXPECT_EQ(client.read()["ok"], true);
    EXPECT_EQ(client.read(), Json());
}

TEST_F(ControlServerTest, closesAfterALongLine) {
    start();
    TestClient client(path);
    client.read();
    const std::string part(4096, 'x');
    for (size_t sent = 0; sent < 4 * kMaxControlRequestBytes; sent += part.size()) client.write(part);
    EXPECT_EQ(client.read()["code"], "limit");
}

TEST_F(ControlServerTest, servesManyClientsAndRefusesMore) {
    start();
    std::vector<std::unique_ptr<TestClient>> clients;
    for (size_t i = 0; i < kMaxControlClients; ++i) {
        clients.push_back(std::make_unique<TestClient>(path));
        EXPECT_TRUE(clients.back()->read().contains("hello"));
    }
    TestClient late(path);
    EXPECT_EQ(late.read()["code"], "limit");
    EXPECT_EQ(late.read(), Json());
    for (auto& client : clients) EXPECT_EQ(client->request(kStatus)["ok"], true);
    clients.clear();
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    while (!deadline.passed() && !TestClient(path).read().contains("hello")) poll(nullptr, 0, 10);
    EXPECT_FALSE(deadline.passed());
}

TEST_F(ControlServerTest, repliesToOthersDuringAFlood) {
    start();
    TestClient flood(path), other(path);
    std::string lines;
    for (int i = 0; i < 1000; ++i) lines += "{\"id\":1,\"op\":\"count\"}\n";
    std::atomic<bool> stop{false};
    std::thread writing([&] { // 10⁶ requests, unless the test ends earlier
        for (int i = 0; i < 1000 && !stop; ++i)
            for (size_t done = 0; done < lines.size() && !stop; poll(nullptr, 0, done < lines.size() ? 1 : 0))
                done += flood.write(lines.substr(done), MSG_DONTWAIT);
    });
    std::thread reading([&] {
        while (!stop && !flood.read().is_null()) {}
    });
    other.read();
    const Deadline begin = Deadline::inMs(kPatienceMs);
    while (count == 0 && !begin.passed()) poll(nullptr, 0, 1);
    EXPECT_GT(count, 0);
    for (int i = 0; i < 20; ++i) {
        const int64_t beganNs = monotonicNowNs();
        EXPECT_EQ(other.request(kStatus)["ok"], true);
        EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS);
    }
    stop = true;
    writing.join();
    server.reset(); // ends the flood's connection
    reading.join();
}

TEST_F(ControlServerTest, dropsAClientThatReadsNothing) {
    start(200);
    TestClient silent(path), other(path);
    std::string lines;
    for (int i = 0; i < 100; ++i) lines += "{\"id\":1,\"op\":\"help\"}\n";
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    bool isClosed = false;
    while (!isClosed && !deadline.passed()) {
        errno = 0;
        silent.write(lines, MSG_DONTWAIT);
        isClosed = errno == EPIPE || errno == ECONNRESET;
        poll(nullptr, 0, 1);
    }
    EXPECT_TRUE(isClosed);
    other.read();
    EXPECT_EQ(other.request(kStatus)["ok"], true);
}

TEST_F(ControlServerTest, survivesClientsThatVanish) {
    start();
    for (int i = 0; i < 100; ++i) {
        TestClient client(path);
        client.write(std::string(kStatus).substr(0, static_cast<size_t>(i) % 30));
    }
    TestClient client(path);
    client.read();
    EXPECT_EQ(client.request(kStatus)["ok"], true);
}

TEST_F(ControlServerTest, sendsLogLinesEventsAndStatus) {
    start();
    const LogToFeed lines(feed);
    TestClient client(path);
    client.read();
    for (const char* topic : {"log", "events"})
        EXPECT_EQ(client.request(std::string(R"({"id":1,"op":"subscribe","args":{"topic":")") + topic + "\"}}\n")["ok"],
                  true);
    log::info(log::Topic::Node, "node ", 1, " joined");
    feed.publish(ControlTopic::Events, {{"event", "node-joined"}});
    Json log, events;
    for (int i = 0; i < 2; ++i) {
        const Json message = client.read();
        (message["topic"] == "log" ? log : events) = message["data"];
    }
    ASSERT_EQ(log.size(), 1U);
    EXPECT_EQ(log[0]["text"], "node 1 joined");
    EXPECT_EQ(log[0]["topic"], "node");
    EXPECT_EQ(log[0]["level"], "info");
    EXPECT_EQ(events, parseJson(R"([{"event":"node-joined"}])"));
    client.write("{\"id\":2,\"op\":\"subscribe\",\"args\":{\"topic\":\"status\",\"interval\":20}}\n");
    client.read();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(client.read()["data"]["frames"], 7);
}

TEST_F(ControlServerTest, subscribesBeforeTheNextRequest) {
    start();
    const LogToFeed lines(feed);
    TestClient client(path);
    client.read();
    client.write("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"log\"}}\n{\"id\":2,\"op\":\"log\"}\n");
    client.read();
    client.read();
    EXPECT_EQ(client.read()["data"][0]["text"], "performed");
}

TEST_F(ControlServerTest, sendsTheLastEventsAtItsEnd) {
    start();
    TestClient client(path);
    client.read();
    client.request("{\"id\":1,\"op\":\"subscribe\",\"args\":{\"topic\":\"events\",\"interval\":3600000}}\n");
    feed.publish(ControlTopic::Events, {{"event", "stop-requested"}});
    server.reset();
    EXPECT_EQ(client.read()["data"][0]["event"], "stop-requested");
    EXPECT_EQ(client.read(), Json());
}

} // namespace
} // namespace mural
