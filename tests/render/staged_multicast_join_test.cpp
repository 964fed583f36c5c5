// A member that joins a group during its stream continues at the assigned position, with any earlier data.
#include "nodes/render/staged_multicast_join.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <unistd.h>

namespace mural {
namespace {

constexpr int64_t kPatienceMs = 30'000;

std::byte byteAt(uint64_t place) { return static_cast<std::byte>((place * 0x9e3779b97f4a7c15u) >> 56); }

rsp::GroupOptions options(const std::string& control) {
    rsp::GroupOptions o;
    o.group = "239.255.77.88:" + std::to_string(20'000 + ::getpid() % 20'000);
    o.interface = "lo";
    o.control = control;
    o.secret.fill(std::byte{42});
    o.seal = rsp::Seal::ChaCha;
    // Generous timeouts: busy machines are slow, and this is no test of speed.
    o.silentMs = o.stalledMs = kPatienceMs;
    o.probeMs = 10'000;
    return o;
}

// The errors of a late member that is not admitted.
struct Complaints {
    std::function<void(const std::string&)> receiver() {
        return [this](const std::string& why) {
            const std::lock_guard lock(mutex);
            all.push_back(why);
            changed.notify_all();
        };
    }
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::string> all;
};

class Writer {
public:
    explicit Writer(rsp::Group& group) : group_(group) {}
    // Writes pieces that fill no datagram, so that positions lie within datagrams.
    void write(size_t sizeBytes) {
        std::vector<std::byte> piece;
        while (sizeBytes > 0) {
            piece.resize(std::min<size_t>(sizeBytes, 7'777));
            for (size_t i = 0; i < piece.size(); ++i) piece[i] = byteAt(written_ + i);
            ASSERT_TRUE(group_.write(piece, Deadline::inMs(kPatienceMs)));
            written_ += piece.size();
            sizeBytes -= piece.size();
        }
    }
    [[nodiscard]] uint64_t written() const { return written_; }

private:
    rsp::Group& group_;
    uint64_t written_ = 0;
};

// Returns the position of the first byte that the next member receives.
std::optional<uint64_t> comesFrom(rsp::Group& host, Writer& writer) {
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    while (!deadline.passed()) {
        writer.write(1'001);
        for (const rsp::MemberEvent& event : host.takeEvents())
            if (event.kind == rsp::MemberEvent::Kind::Came) return event.info.fromByte;
        ::usleep(1'000);
    }
    return std::nullopt;
}

// Joins a stream and checks its contents. `meanwhileBytes` are written between the join and the position at which the
// member continues.
void goesOn(size_t meanwhileBytes) {
    auto host = rsp::Group::host(options("127.0.0.1:0"));
    ASSERT_TRUE(host) << host.error().message;
    Writer writer(**host);
    writer.write(100'003);
    Complaints complaints;
    StagedMulticastJoin late(options((*host)->controlAddress()), complaints.receiver());
    const auto from = comesFrom(**host, writer);
    ASSERT_TRUE(from.has_value());
    writer.write(meanwhileBytes);
    const uint64_t place = writer.written();
    writer.write(50'000);
    (*host)->flush();
    auto stream = late.goOn(place - *from, Deadline::inMs(kPatienceMs));
    ASSERT_TRUE(stream) << stream.error().message;
    std::vector<std::byte> read(50'000);
    for (size_t at = 0; at < read.size(); at += 12'500)
        ASSERT_TRUE((*stream)->read(std::span(read).subspan(at, 12'500), Deadline::inMs(kPatienceMs)));
    size_t wrong = 0;
    for (size_t i = 0; i < read.size(); ++i) wrong += read[i] != byteAt(place + i);
    EXPECT_EQ(wrong, 0u);
    EXPECT_TRUE(complaints.all.empty());
}

TEST(StagedMulticastJoin, continuesAtTheJoin) { goesOn(0); }
// More than the datagram window holds: the member reads data before it receives the position at which it continues.
TEST(StagedMulticastJoin, continuesFarAfterTheJoin) { goesOn(20'000'000); }

TEST(StagedMulticastJoin, reportsAFailedJoin) {
    std::string nobody;
    {
        auto host = rsp::Group::host(options("127.0.0.1:0"));
        ASSERT_TRUE(host) << host.error().message;
        nobody = (*host)->controlAddress();
    }
    Complaints complaints;
    StagedMulticastJoin late(options(nobody), complaints.receiver());
    {
        std::unique_lock lock(complaints.mutex);
        ASSERT_TRUE(complaints.changed.wait_for(lock, std::chrono::milliseconds(kPatienceMs),
                                                [&] { return !complaints.all.empty(); }));
        EXPECT_NE(complaints.all[0].find("127.0.0.1"), std::string::npos) << complaints.all[0];
    }
    EXPECT_FALSE(late.goOn(0, Deadline::inMs(1)));
}

} // namespace
} // namespace mural
