// A complete head of a test with the socket of its control interface, and one client that is connected to it.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>

#include "common/json/json_text.hpp"
#include "tests/head/support/session_harness.hpp"
#include "tests/temporary_folder.hpp"

namespace mural {

class ControlledSession : public SessionHarness {
public:
    explicit ControlledSession(int nodes) : SessionHarness(nodes) { config.socketPath = folder_.at("socket"); }
    void open() {
        start();
        waitFor("ready");
        socket_ = FileDescriptor(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        folder_.at("control").copy(address.sun_path, sizeof address.sun_path - 1);
        ASSERT_EQ(connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        hello = line()["hello"];
    }
    nlohmann::json line() {
        const Deadline deadline = Deadline::inMs(kTestPatienceMs);
        size_t end = 0;
        while ((end = received_.find('\n')) == std::string::npos && !deadline.passed()) {
            pollfd ready{socket_.get(), POLLIN, 0};
            char part[4096];
            if (poll(&ready, 1, 100) <= 0) continue;
            const ssize_t n = recv(socket_.get(), part, sizeof part, 0);
            if (n <= 0) return {};
            received_.append(part, static_cast<size_t>(n));
        }
        const nlohmann::json json = parseJson(received_.substr(0, end));
        received_.erase(0, end + 1);
        return json;
    }
    nlohmann::json request(const std::string& operation, const nlohmann::json& arguments = nlohmann::json::object()) {
        const std::string text = jsonText(nlohmann::json{{"id", 1}, {"op", operation}, {"args", arguments}}) + "\n";
        EXPECT_EQ(send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
        nlohmann::json reply;
        do reply = line();
        while (reply.contains("topic"));
        return reply;
    }
    // Returns the next event of that name, from messages of the subscription.
    nlohmann::json event(const std::string& name) {
        for (nlohmann::json message = line(); message.is_object(); message = line())
            for (const nlohmann::json& entry : message["data"])
                if (entry["event"] == name) return entry;
        ADD_FAILURE() << "no event " << name;
        return {};
    }
    nlohmann::json hello;

private:
    test::TemporaryFolder folder_;
    FileDescriptor socket_;
    std::string received_;
};

} // namespace mural
