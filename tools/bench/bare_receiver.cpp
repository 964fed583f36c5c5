// Measures a lower bound of the receive cost with recvmmsg. Drains a socket every 4 ms, the rest interval of RSP's
// readers. Each call reads 32 datagrams, always into the same buffers, without processing. Independent of Mural.
//
//   bare_receiver GROUP PORT INTERFACE-ADDRESS    runs until 0.4 s of silence; prints one line
#include <arpa/inet.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

namespace {

constexpr size_t kAtOnce = 32;
constexpr size_t kPlaceBytes = 9216; // a jumbo datagram
constexpr int kSocketBytes = 8 << 20;
constexpr int64_t kNsPerS = 1'000'000'000;
constexpr int64_t kRestNs = 4'000'000;
constexpr int64_t kOverNs = 400'000'000;
constexpr int64_t kComesWithinNs = 30 * kNsPerS;

int64_t nowNs() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * kNsPerS + t.tv_nsec;
}

double cpuS() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec) * 1e-6;
}

int failed(const char* what) {
    std::fprintf(stderr, "bare_receiver: %s: %s\n", what, std::strerror(errno));
    return 1;
}

class Messages {
public:
    explicit Messages(size_t placeBytes) : bytes_(placeBytes * kAtOnce) {
        for (size_t i = 0; i < kAtOnce; ++i) {
            pieces_[i] = {bytes_.data() + i * placeBytes, placeBytes};
            messages_[i].msg_hdr.msg_iov = &pieces_[i];
            messages_[i].msg_hdr.msg_iovlen = 1;
        }
    }
    // Drains the socket; returns the number of bytes.
    uint64_t empty(int socket) {
        uint64_t bytes = 0;
        for (int count = kAtOnce; count == static_cast<int>(kAtOnce);) {
            count = recvmmsg(socket, messages_.data(), kAtOnce, MSG_DONTWAIT, nullptr);
            for (int i = 0; i < count; ++i) bytes += messages_[static_cast<size_t>(i)].msg_len;
        }
        return bytes;
    }

private:
    std::vector<char> bytes_;
    std::array<iovec, kAtOnce> pieces_{};
    std::array<mmsghdr, kAtOnce> messages_{};
};

} // namespace

int main(int count, char** words) {
    if (count != 4) {
        std::fprintf(stderr, "bare_receiver: give GROUP PORT INTERFACE-ADDRESS, as 239.1.1.1 6000 10.77.0.2\n");
        return 2;
    }
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return failed("no socket");
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(static_cast<uint16_t>(std::atoi(words[2])));
    ip_mreq membership{};
    if (inet_pton(AF_INET, words[1], &group.sin_addr) != 1 ||
        inet_pton(AF_INET, words[3], &membership.imr_interface) != 1) {
        std::fprintf(stderr, "bare_receiver: \"%s\" or \"%s\" is no IPv4 address\n", words[1], words[3]);
        return 2;
    }
    membership.imr_multiaddr = group.sin_addr;
    const int on = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kSocketBytes, sizeof kSocketBytes) != 0)
        setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kSocketBytes, sizeof kSocketBytes);
    if (bind(socket, reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) return failed("cannot bind");
    if (setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0)
        return failed("cannot join");

    Messages messages(kPlaceBytes);
    const int64_t startNs = nowNs();
    int64_t firstNs = 0;
    int64_t lastNs = 0;
    double cpuBeganS = 0;
    uint64_t bytes = 0;
    while (true) {
        const uint64_t came = messages.empty(socket);
        const int64_t now = nowNs();
        if (came > 0 && firstNs == 0) {
            firstNs = now;
            cpuBeganS = cpuS();
        } else {
            bytes += came; // the first read precedes the measurement
        }
        if (came > 0) lastNs = now;
        if (firstNs != 0 ? now - lastNs > kOverNs : now - startNs > kComesWithinNs) break;
        const timespec rest{0, kRestNs};
        nanosleep(&rest, nullptr);
    }
    if (bytes == 0) {
        std::fprintf(stderr, "bare_receiver: nothing came within 30 s\n");
        return 1;
    }
    const double gigabytes = static_cast<double>(bytes) * 1e-9;
    std::printf("gbit=%.3f cpu_s_per_GB=%.3f\n",
                gigabytes * 8 * static_cast<double>(kNsPerS) / static_cast<double>(lastNs - firstNs),
                (cpuS() - cpuBeganS) / gigabytes);
    return 0;
}
