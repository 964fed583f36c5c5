// Writes the corpus of the network's fuzz targets, one folder each. Usage: network_fuzz_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/base/little_endian.hpp"
#include "tests/fuzz/network/group_steps.hpp"
#include "tests/fuzz/network/secure_channel_steps.hpp"
#include "tests/fuzz/network/stream_steps.hpp"
#include "tools/mural/network/probe_datagram.hpp"
#include "transport/discovery/announcement.hpp"
#include "transport/rsp/wire/control_message.hpp"

namespace mural::fuzz {
namespace {

using namespace rsp;
using Bytes = std::vector<std::byte>;

class Seed {
public:
    Seed& byte(unsigned value) {
        bytes_.push_back(static_cast<std::byte>(value));
        return *this;
    }
    template <class Step> Seed& step(Step s) { return byte(static_cast<unsigned>(s)); }
    Seed& half(unsigned value) { return byte(value & 0xff).byte(value >> 8 & 0xff); }
    Seed& word(uint32_t value) { return half(value & 0xffff).half(value >> 16); }
    Seed& raw(const Bytes& b) {
        bytes_.insert(bytes_.end(), b.begin(), b.end());
        return *this;
    }
    Seed& piece(const Bytes& b) { return half(static_cast<unsigned>(b.size())).raw(b); }
    // Appends a position and bits that change nothing.
    Seed& unchanged() { return half(0).byte(0); }
    void save(const std::filesystem::path& folder, const std::string& target, const std::string& name) const {
        std::filesystem::create_directories(folder / target);
        std::ofstream(folder / target / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
    }

private:
    Bytes bytes_;
};

Bytes streamBytes(Type type, uint32_t sequence, unsigned index, unsigned size, size_t payload, uint8_t flags = 0) {
    Bytes bytes(kStreamHeaderBytes + payload, std::byte{5});
    StreamDatagram d;
    d.type = type;
    d.flags = flags;
    d.sequence = Sequence(sequence);
    d.index = static_cast<uint8_t>(index);
    d.groupSize = static_cast<uint8_t>(size);
    d.sentUs = 1000;
    d.next = Sequence(sequence + 1);
    writeStreamHeader(d, bytes);
    return bytes;
}

Bytes feedbackOf(uint32_t cumulative, uint32_t highest, unsigned entries) {
    Feedback f;
    f.from = 1;
    f.cumulative = Sequence(cumulative);
    f.edge = Sequence(cumulative + 64);
    f.highest = Sequence(highest);
    f.echoUs = 900'000;
    f.entryCount = static_cast<uint16_t>(entries);
    for (unsigned i = 0; i < entries; ++i) f.entries[i] = {Sequence(cumulative + i * 4), 5, 1, 4};
    Bytes bytes(feedbackBytes(f));
    writeFeedback(f, bytes);
    return bytes;
}

std::vector<std::pair<std::string, ControlMessage>> messages() {
    Join join;
    join.udpPort = 4711;
    join.socketDatagrams = 64;
    join.maxDatagramBytes = 512;
    join.seals = 0xff;
    Welcome welcome;
    welcome.self = 1;
    welcome.group = "239.255.77.85:4277";
    welcome.datagramBytes = 512;
    welcome.windowDatagrams = 64;
    welcome.probeNonce = 2;
    return {{"join", join},
            {"welcome", welcome},
            {"probed", Probed{2}},
            {"member_came", MemberCame{2, {}, "192.0.2.2", 4711, true}},
            {"stream_start", StreamStart{0, 1, Sequence(9)}},
            {"member_gone", MemberGone{2, GoneReason::Silent}},
            {"tunnel", Tunnel{0, streamBytes(Type::Data, 9, 0, 1, 20)}},
            {"refused", Refused{"full"}},
            {"leave", Leave{}},
            {"ping", Ping{7, false}}};
}

void datagrams(const std::filesystem::path& folder) {
    for (unsigned seal = 0; seal < 4; ++seal) {
        Seed s;
        s.byte(seal);
        for (const Type type : {Type::Data, Type::Parity, Type::Poll})
            s.byte(0).piece(streamBytes(type, 7, 0, 4, type == Type::Poll ? 0 : 40));
        s.byte(0).piece(feedbackOf(7, 20, 3));
        s.byte(1).piece(streamBytes(Type::Data, 7, 1, 4, 60));
        s.byte(2).unchanged().piece(Bytes(50, std::byte{9}));
        s.byte(2).half(30).byte(4).piece(Bytes(50, std::byte{9}));
        s.save(folder, "datagram", "seal_" + std::to_string(seal));
    }
}

void controlMessages(const std::filesystem::path& folder) {
    for (const auto& [name, message] : messages()) Seed().raw(encode(message)).save(folder, "control_message", name);
}

void streams(const std::filesystem::path& folder) {
    for (const uint32_t first : {7u, 0xfffffff0u}) {
        Seed s;
        s.word(first);
        const auto pass = [&](int count) {
            for (int i = 0; i < count; ++i) s.step(StreamStep::PassOn).unchanged();
        };
        s.step(StreamStep::Write).half(5000).step(StreamStep::Flush);
        pass(8);
        s.step(StreamStep::Lose).step(StreamStep::Lose);
        pass(40);
        s.step(StreamStep::Wait).word(20'000);
        for (int i = 0; i < 6; ++i) s.step(StreamStep::Answer).unchanged();
        pass(8);
        s.step(StreamStep::Read)
            .half(3000)
            .step(StreamStep::AddMember)
            .byte(2)
            .step(StreamStep::Write)
            .half(20'000)
            .step(StreamStep::Flush);
        pass(64);
        s.step(StreamStep::Wait)
            .word(200'000)
            .step(StreamStep::Answer)
            .unchanged()
            .step(StreamStep::RemoveMember)
            .byte(2);
        s.step(StreamStep::ToReader).piece(streamBytes(Type::Data, first + 40, 3, 8, 40, flag::kPoll));
        s.step(StreamStep::ToReader).piece(streamBytes(Type::Parity, first + 32, 0, 8, 42));
        s.step(StreamStep::ToReader).piece(streamBytes(Type::Poll, first + 32, 0, 8, 0, flag::kPoll));
        s.step(StreamStep::ToWriter).piece(feedbackOf(first, first + 20, 5));
        s.step(StreamStep::Wait).word(5'000'000);
        s.save(folder, "stream", first == 7 ? "losses" : "losses_wrap");
    }
}

void groups(const std::filesystem::path& folder) {
    const auto join = [](Seed& s, bool probed) {
        s.step(GroupStep::PassToHost).unchanged().step(GroupStep::PassToMember).unchanged(); // join, welcome
        if (probed)
            s.step(GroupStep::PassDatagramToMember).unchanged().step(GroupStep::PassToHost).unchanged();
        else
            s.step(GroupStep::Wait).word(400'000);
        for (int i = 0; i < 4; ++i) s.step(GroupStep::PassToMember).unchanged().step(GroupStep::PassToHost).unchanged();
    };
    for (const bool probed : {true, false}) {
        Seed s;
        join(s, probed);
        s.step(GroupStep::WriteAtHost).half(9000).step(GroupStep::WriteAtMember).half(2000);
        for (int i = 0; i < 24; ++i) {
            s.step(GroupStep::PassDatagramToMember).unchanged().step(GroupStep::PassDatagramToHost).unchanged();
            s.step(GroupStep::PassToMember).unchanged().step(GroupStep::PassToHost).unchanged();
        }
        s.step(GroupStep::ReadAll).step(GroupStep::Connect);
        for (const auto& [name, message] : messages()) s.step(GroupStep::ControlToHost).byte(2).piece(encode(message));
        for (const auto& [name, message] : messages()) s.step(GroupStep::ControlToMember).piece(encode(message));
        s.step(GroupStep::DatagramToHost)
            .piece(streamBytes(Type::Data, 0, 0, 4, 60))
            .step(GroupStep::DatagramToMember)
            .piece(feedbackOf(0, 4, 2));
        s.step(GroupStep::Disconnect).byte(2).step(GroupStep::Wait).word(3'000'000);
        s.save(folder, "group", probed ? "multicast" : "tunnel");
    }
}

void announcements(const std::filesystem::path& folder) {
    Announcement a{AnnouncementKind::Here, 4278, {}, "wall1", "0.1.0"};
    Seed().raw(encode(a)).save(folder, "announcement", "here");
    a.kind = AnnouncementKind::Gone;
    Seed().raw(encode(a)).save(folder, "announcement", "gone");
    Seed().raw(encode(Announcement{AnnouncementKind::Search, 0, {}, "", ""})).save(folder, "announcement", "asked");
}

void probes(const std::filesystem::path& folder) {
    for (const cli::ProbePath way : cli::kProbePaths) {
        Bytes bytes(60);
        cli::writeProbe({7, way, true, static_cast<uint16_t>(bytes.size())}, bytes);
        Seed().raw(bytes).save(folder, "probe_datagram", "way_" + std::to_string(static_cast<int>(way)));
    }
}

void channels(const std::filesystem::path& folder) {
    constexpr unsigned kHostsStep = 0x80;
    for (const bool same : {true, false}) {
        Seed s;
        s.byte(same ? 0 : 1);
        const auto pass = [&](unsigned whose) {
            s.byte(whose | static_cast<unsigned>(ChannelStep::Pass)).half(0xffff).half(0xffff).byte(0);
        };
        pass(0);
        pass(kHostsStep);
        pass(0);
        pass(kHostsStep);
        for (const unsigned whose : {0u, kHostsStep}) {
            s.byte(whose | static_cast<unsigned>(ChannelStep::Send)).piece(Bytes(30, std::byte{3}));
            s.byte(whose | static_cast<unsigned>(ChannelStep::Send)).piece({});
            pass(whose);
        }
        s.byte(static_cast<unsigned>(ChannelStep::Finish));
        pass(0);
        s.byte(kHostsStep | static_cast<unsigned>(ChannelStep::Add)).piece(Bytes(40, std::byte{1}));
        s.save(folder, "secure_channel", same ? "talk" : "other_secret");
    }
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "network_fuzz_seeds FOLDER\n");
        return 1;
    }
    mural::fuzz::datagrams(argv[1]);
    mural::fuzz::controlMessages(argv[1]);
    mural::fuzz::streams(argv[1]);
    mural::fuzz::groups(argv[1]);
    mural::fuzz::channels(argv[1]);
    mural::fuzz::probes(argv[1]);
    mural::fuzz::announcements(argv[1]);
}
