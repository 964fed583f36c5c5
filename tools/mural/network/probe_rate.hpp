// Measures the rate of a TCP connection between the doctor and a host in both directions, one after the other. The
// doctor connects, so the measurement also shows whether the host can be reached.
//
//   doctor: 32 bytes of the token, then zeros for some time, then the end of its direction
//   host:   zeros for the same time, then the end
//
// Each receiver measures the rate.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::cli {

constexpr size_t kRateTokenBytes = 32;

struct RateMeasured {
    double bytesPerS = 0; // 0: not measured
    std::string problem;  // empty: none
};

// The host's end. Accepts one connection that presents the token.
class RateListener {
public:
    static Result<std::unique_ptr<RateListener>> start(int family, std::string token, int64_t durationMs);
    RateListener(const RateListener&) = delete;
    RateListener& operator=(const RateListener&) = delete;
    ~RateListener();

    [[nodiscard]] uint16_t port() const { return port_; }
    // Waits for the end of the measurement, some seconds at most. Returns the rate of the doctor's bytes.
    RateMeasured finish();

private:
    RateListener(FileDescriptor socket, uint16_t port, std::string token, int64_t durationMs);
    void serve();

    FileDescriptor socket_;
    uint16_t port_;
    std::string token_;
    int64_t durationMs_;
    RateMeasured received_;
    std::thread thread_;
};

// The doctor's end. Errors: the host cannot be reached. The result is the rate of the host's bytes.
Result<RateMeasured> measureRate(const SocketAddress& host, const std::string& token, int64_t durationMs);

// Opens a socket that accepts connections on any port of this machine.
Result<FileDescriptor> listenAnywhere(int family);

} // namespace mural::cli
