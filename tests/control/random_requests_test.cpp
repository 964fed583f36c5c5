// The control protocol with pseudo-random bytes and damaged requests: every line has one valid reply, memory stays
// bounded. tests/fuzz/control searches further.
#include <gtest/gtest.h>
#include <random>

#include "common/base/clock.hpp"
#include "tests/control/sample_operations.hpp"
#include "tests/sanitized.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

class Requests {
public:
    explicit Requests(uint32_t seed) : random_(seed) {}
    size_t below(size_t n) { return random_() % n; }

    std::string next() {
        static const std::vector<std::string> kLines = {
            R"({"id":1,"op":"status"})",
            R"({"id":2,"op":"echo","args":{"whole":1,"text":"a\u00e4\"","truth":false,"scalar":-0.5e3}})",
            R"({"id":3,"op":"restart-node","args":{"node":1}})",
            R"({"id":4,"op":"subscribe","args":{"topic":"status","interval":20}})",
            R"({"id":5,"op":"subscribe","args":{"topic":"log"}})",
            R"({"id":6,"op":"unsubscribe","args":{"topic":"log"}})",
            R"({"id":7,"op":"help"})"};
        std::string line = kLines[below(kLines.size())];
        for (size_t n = below(4); n > 0; --n) damage(line, kLines[below(kLines.size())]);
        return line + "\n";
    }

private:
    void damage(std::string& line, const std::string& other) {
        const size_t at = below(line.size() + 1);
        switch (below(4)) {
        case 0: line.insert(at, 1, static_cast<char>(below(256))); break;
        case 1: line.erase(at, below(8)); break;
        case 2: line.insert(at, other.substr(below(other.size()), below(12))); break;
        default: line.insert(at, std::string(below(40), "[{\"\\"[below(4)])); break;
        }
    }
    std::mt19937 random_;
};

bool isBlank(const std::string& line) { return line.find_first_not_of(" \t\r") == std::string::npos; }

size_t countLines(const std::string& bytes) {
    size_t lines = 0, at = 0;
    for (size_t end = 0; (end = bytes.find('\n', at)) != std::string::npos; at = end + 1)
        lines += isBlank(bytes.substr(at, end - at)) ? 0 : 1;
    return lines;
}

TEST(RandomRequests, haveOneValidReplyEach) {
    const ControlOperations operations = sampleOperations();
    for (uint32_t seed = 1; seed <= mural::testing::rounds(200); ++seed) {
        SCOPED_TRACE(seed);
        Requests requests(seed);
        ControlProtocol client(operations, Json::object());
        takeLines(client);
        size_t replies = 0, wanted = 0;
        for (int i = 0; i < 100; ++i) {
            const std::string bytes = requests.next();
            wanted += countLines(bytes);
            const size_t half = requests.below(bytes.size());
            client.receive(bytes.substr(0, half));
            client.perform(1000, i);
            client.receive(bytes.substr(half));
            client.perform(1000, i);
            client.offer(ControlTopic::Log, R"({"text":"line"})");
            client.sendMessages(i * kNsPerS);
            for (const Json& line : takeLines(client)) { // throws unless each line is valid
                if (line.contains("topic")) continue;
                ++replies;
                ASSERT_TRUE(line["ok"].is_boolean());
                ASSERT_EQ(line["ok"] == false, line.contains("error"));
            }
        }
        EXPECT_EQ(replies, wanted);
        EXPECT_FALSE(client.isOver());
    }
}

TEST(RandomRequests, surviveAnyBytes) {
    const ControlOperations operations = sampleOperations();
    std::mt19937 random(7);
    for (uint64_t run = 0; run < mural::testing::rounds(100); ++run) {
        ControlProtocol client(operations, Json::object());
        for (int i = 0; i < 40 && client.acceptsBytes(); ++i) {
            std::string bytes(1 + random() % 4096, '\0');
            for (char& c : bytes) c = static_cast<char>(random());
            client.receive(bytes);
            while (client.hasRequest()) client.perform(16, i);
            takeLines(client);
        }
    }
}

} // namespace
} // namespace mural
