// Throughput of each kind of connection relative to memcpy of the same bytes, and the time of a round trip. Both are
// measured alternately; prints median and spread of the ratio. Arguments select kinds: mural_transport_bench Tcp Fabric
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <thread>
#include <vector>

#include "tests/transport/linked_pair.hpp"

namespace mural::test {

namespace {

constexpr int kRounds = 9;

void require(bool ok, const char* what) {
    if (ok) return;
    std::fprintf(stderr, "connection_bench: %s\n", what);
    std::exit(1);
}

double seconds(int64_t beginNs) { return static_cast<double>(monotonicNowNs() - beginNs) / kNsPerS; }

double copySeconds(const std::vector<std::byte>& from, std::vector<std::byte>& to, size_t total, size_t piece) {
    const int64_t beginNs = monotonicNowNs();
    for (size_t done = 0; done < total; done += piece) {
        const size_t at = done % (from.size() - piece + 1);
        std::memcpy(to.data() + at, from.data() + at, piece);
        asm volatile("" : : "r"(to.data()) : "memory");
    }
    return seconds(beginNs);
}

double streamSeconds(LinkedPair& link, const std::vector<std::byte>& from, std::vector<std::byte>& to, size_t total,
                     size_t piece) {
    const Deadline deadline = Deadline::inMs(60000);
    const int64_t beginNs = monotonicNowNs();
    std::thread writer([&] {
        for (size_t done = 0; done < total; done += piece) {
            const size_t at = done % (from.size() - piece + 1);
            require(link.a->write(std::span(from).subspan(at, piece), deadline).ok(), "write failed");
        }
        link.a->flush();
    });
    for (size_t done = 0; done < total; done += piece) {
        const size_t at = done % (to.size() - piece + 1);
        require(link.b->read(std::span(to).subspan(at, piece), deadline).ok(), "read failed");
    }
    writer.join();
    const double took = seconds(beginNs);
    require(std::memcmp(from.data(), to.data(), std::min(total, from.size()) / piece * piece) == 0, "bytes differ");
    return took;
}

void benchStream(LinkKind kind, size_t capacityBytes, size_t piece, size_t total) {
    LinkedPair link = makeLinkedPair(kind, capacityBytes);
    require(link.a && link.b, "no link");
    total = total / piece * piece;
    std::vector<std::byte> from(std::max(piece, size_t{32} << 20) / piece * piece);
    ByteStream(1).fill(from);
    std::vector<std::byte> to = from;
    std::vector<double> ratios;
    std::vector<double> rates;
    for (int i = 0; i < kRounds; ++i) {
        const double copied = copySeconds(from, to, total, piece);
        const double streamed = streamSeconds(link, from, to, total, piece);
        ratios.push_back(copied / streamed);
        rates.push_back(static_cast<double>(total) / streamed / 1e9);
    }
    std::sort(ratios.begin(), ratios.end());
    std::sort(rates.begin(), rates.end());
    std::printf("%s,%zu,%zu,%.2f,%.2f,%.2f,%.2f\n", linkName(kind).c_str(), capacityBytes, piece, rates[kRounds / 2],
                ratios[kRounds / 2], ratios.front(), ratios.back());
}

void benchAnswers(LinkKind kind) {
    LinkedPair link = makeLinkedPair(kind, size_t{1} << 20);
    require(link.a && link.b, "no link");
    constexpr int kQuestions = 20000;
    const Deadline deadline = Deadline::inMs(60000);
    std::thread answerer([&] {
        std::byte value{};
        for (int i = 0; i < kQuestions; ++i) {
            require(link.b->read(std::span(&value, 1), deadline).ok(), "read failed");
            require(link.b->write(std::span(&value, 1), deadline).ok(), "write failed");
            link.b->flush();
        }
    });
    const int64_t beginNs = monotonicNowNs();
    std::byte value{};
    for (int i = 0; i < kQuestions; ++i) {
        require(link.a->write(std::span(&value, 1), deadline).ok(), "write failed");
        link.a->flush();
        require(link.a->read(std::span(&value, 1), deadline).ok(), "read failed");
    }
    const double took = seconds(beginNs);
    answerer.join();
    std::printf("%s,%.2f\n", linkName(kind).c_str(), took / kQuestions * 1e6);
}

} // namespace

} // namespace mural::test

int main(int count, char** arguments) {
    using namespace mural::test;
    const std::vector<std::string> wanted(arguments + 1, arguments + count);
    std::vector<LinkKind> kinds;
    for (const LinkKind kind : kAllLinkKinds) {
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), linkName(kind)) == wanted.end()) continue;
        const std::string why = whyNoLinks(kind);
        if (why.empty())
            kinds.push_back(kind);
        else
            std::fprintf(stderr, "no %s: %s\n", linkName(kind).c_str(), why.c_str());
    }
    require(kinds.size() >= std::max<size_t>(wanted.size(), 1), "a kind that was named is missing");
    std::printf("kind,capacityBytes,pieceBytes,GB/s,ratioToMemcpy,ratioMin,ratioMax\n");
    for (const LinkKind kind : kinds) {
        for (const size_t capacity : {size_t{1} << 20, size_t{16} << 20}) {
            if ((kind == LinkKind::Tcp || kind == LinkKind::Fabric) && capacity != size_t{1} << 20) continue;
            benchStream(kind, capacity, 64, size_t{32} << 20);
            benchStream(kind, capacity, 4096, size_t{256} << 20);
            benchStream(kind, capacity, size_t{1} << 20, size_t{512} << 20);
            benchStream(kind, capacity, size_t{8} << 20, size_t{512} << 20);
        }
    }
    std::printf("kind,microsecondsPerQuestionAndAnswer\n");
    for (const LinkKind kind : kinds) benchAnswers(kind);
    return 0;
}
