#include "tools/mural/network/probe_member.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <sys/socket.h>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/session/session_secret.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/network/line_channel.hpp"
#include "tools/mural/hosts/host_facts.hpp"
#include "tools/mural/network/machine_facts.hpp"
#include "tools/mural/network/probe_rate.hpp"
#include "tools/mural/network/probe_sockets.hpp"
#include "transport/rsp/group.hpp"
#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;

constexpr int64_t kSilenceMs = 600'000; // other hosts are surveyed in the meantime
constexpr int64_t kConnectMs = 2'000;   // per address
constexpr int64_t kJoinGroupMs = 10'000;
constexpr int64_t kSpeakMs = 10'000;
constexpr int kBetweenDatagramsMs = 1;

// The route to the doctor's machine.
struct Route {
    std::string reached; // reachable address of the doctor's machine
    std::string own;     // source address chosen by the kernel
    std::string why;     // reason if none is reachable
};

Route findRoute(const std::vector<std::string>& addresses, uint16_t port) {
    Route route;
    for (const std::string& host : addresses) {
        auto address = numericAddress(host, port);
        if (!address) continue;
        const FileDescriptor fd(::socket(address->family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        int code = ::connect(fd.get(), address->get(), address->sizeBytes) == 0 ? 0 : errno;
        if (code == EINPROGRESS) {
            socklen_t size = sizeof code;
            if (waitForSocket(fd.get(), POLLOUT, Deadline::inMs(kConnectMs)) == 0)
                code = ETIMEDOUT;
            else if (getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &code, &size) != 0)
                code = errno;
        }
        if (code == 0) return {host, numericText(localTcpAddress(fd.get())), {}};
        route.why += fmt::format("{}{}: {}", route.why.empty() ? "" : ", ", host, errnoText(code));
    }
    return route;
}

// The time of day. Tests plant a wrong clock by a variable.
int64_t wallClockNs() {
    timespec t{};
    clock_gettime(CLOCK_REALTIME, &t);
    const char* wrong = std::getenv("MURAL_TEST_CLOCK_OFFSET_MS");
    return static_cast<int64_t>(t.tv_sec) * kNsPerS + t.tv_nsec + (wrong ? std::atoll(wrong) * kNsPerMs : 0);
}

// A member of the doctor's group that reads and discards the stream.
class Reading {
public:
    explicit Reading(std::unique_ptr<rsp::Group> group) : group_(std::move(group)), thread_([this] { read(); }) {}
    ~Reading() {
        stop_ = true;
        thread_.join();
    }
    [[nodiscard]] json report() const {
        const rsp::GroupReport r = group_->report();
        return {{"bytes", bytes_.load()},
                {"socketDropped", r.socketDropped},
                {"refused", r.refused.all()},
                {"queueDropped", droppedByQueues() - queueDropped_}};
    }

private:
    void read() {
        std::vector<std::byte> piece(256 * 1024);
        while (!stop_) {
            auto count = group_->read(rsp::kHost, piece, Deadline::inMs(100));
            if (count && *count == 0) return; // the doctor has finished
            if (count) bytes_ += *count;
        }
    }
    std::unique_ptr<rsp::Group> group_;
    const uint64_t queueDropped_ = droppedByQueues();
    std::atomic<uint64_t> bytes_ = 0;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

class Member {
public:
    explicit Member(LineChannel lines) : lines_(std::move(lines)) {}

    int run() {
        auto first = lines_.read(Deadline::inMs(kSilenceMs));
        if (!first)
            return failed("no command from mural doctor on standard input: " + first.error().message +
                          "; mural doctor --network starts this process");
        try {
            if (auto r = begin(parseJson(*first)); !r) return failed(r.error().message);
            return converse();
        } catch (const json::exception& e) {
            return failed(std::string("invalid command from mural doctor: ") + e.what() +
                          "; check that both run the same version");
        }
    }

private:
    int failed(const std::string& why) {
        fmt::print(stderr, "mural network-member: {}\n", why);
        (void)lines_.write(jsonText(json{{"failed", why}}), Deadline::inMs(kSpeakMs));
        return 1;
    }

    Result<void> begin(const json& order) {
        auto secret = sessionSecretFromHex(order.at("secret").get<std::string>());
        if (!secret) return secret.error();
        auto group = numericEndpoint(order.at("group").get<std::string>());
        if (!group) return group.error();
        const Route route =
            findRoute(order.at("addresses").get<std::vector<std::string>>(), order.at("port").get<uint16_t>());
        // Default: the interface that leads to the doctor.
        std::string wanted = order.at("interface").get<std::string>();
        if (wanted.empty()) wanted = route.own;
        auto interface = rsp::findInterface(wanted, group->family());
        if (!interface) interface = rsp::findInterface("", group->family());
        if (!interface) return interface.error();
        auto sockets = ProbeSockets::open(*group, *interface, order.at("survey").get<uint64_t>(), false);
        if (!sockets) return sockets.error();
        sockets_.emplace(std::move(*sockets));
        options_.secret = *secret;
        options_.group = order.at("group").get<std::string>();
        options_.interface = interface->name;
        const json hello{{"version", muralVersion()},
                         {"reached", route.reached},
                         {"own", route.own},
                         {"why", route.why},
                         {"port", sockets_->port()},
                         {"troubles", troubles()},
                         {"facts", toJson(readMachineFacts(*interface, sockets_->bufferBytes()))}};
        return lines_.write(jsonText(hello), Deadline::inMs(kSpeakMs));
    }

    int converse() {
        Deadline deadline = Deadline::inMs(kSilenceMs);
        while (sockets_->listen(deadline, lines_.readableFd())) {
            auto line = lines_.read(Deadline::inMs(kSpeakMs));
            if (!line) return 0; // the doctor has ended
            if (auto r = lines_.write(jsonText(answer(parseJson(*line))), Deadline::inMs(kSpeakMs)); !r) return 0;
            deadline = Deadline::inMs(kSilenceMs);
        }
        return failed("no command from mural doctor for ten minutes; start it again");
    }

    json answer(const json& order) {
        const auto what = order.at("do").get<std::string>();
        if (what == "seen") return seen();
        if (what == "send") return send(order);
        if (what == "join") return join(order);
        if (what == "leave") {
            const json report = reading_ ? reading_->report() : json::object();
            reading_.reset();
            return report;
        }
        if (what == "clock") return {{"ns", wallClockNs()}};
        if (what == "inspect") return inspect(order);
        if (what == "listen") return listen(order);
        if (what == "rate") {
            const RateMeasured rate = rateListener_ ? rateListener_->finish() : RateMeasured{0, "no listener"};
            rateListener_.reset();
            return {{"bytesPerS", rate.bytesPerS}, {"problem", rate.problem}};
        }
        return {{"failed", "unknown command \"" + what + "\"; check that both machines run the same version"}};
    }

    json seen() {
        (void)sockets_->listen(Deadline::inMs(0)); // already received
        json list = json::array();
        for (const auto& [probe, count] : sockets_->take())
            list.push_back({{"path", static_cast<int>(probe.path)}, {"size", probe.sizeBytes}, {"count", count}});
        return {{"seen", list}};
    }

    json send(const json& order) {
        auto to = numericAddress(order.at("to").get<std::string>(), order.at("port").get<uint16_t>());
        if (!to) return {{"failed", to.error().message}};
        for (unsigned copy = 0; copy < order.at("copies").get<unsigned>(); ++copy) {
            for (const ProbePath path : kProbePaths) {
                for (const json& size : order.at("sizes")) {
                    sockets_->send(path, std::clamp<size_t>(size.get<size_t>(), kMinProbeBytes, 65'000), *to);
                    poll(nullptr, 0, kBetweenDatagramsMs);
                }
            }
        }
        return {{"troubles", troubles()}};
    }

    json join(const json& order) {
        rsp::GroupOptions options = options_;
        options.control = order.at("control").get<std::string>();
        reading_.reset();
        auto group = rsp::Group::join(options, Deadline::inMs(kJoinGroupMs));
        if (!group) return {{"joined", false}, {"why", group.error().message}};
        reading_.emplace(std::move(*group));
        return {{"joined", true}, {"why", ""}};
    }

    static json inspect(const json& order) {
        InspectionPlan plan;
        plan.displays = order.at("displays").get<std::vector<std::string>>();
        plan.folder = order.at("folder").get<std::string>();
        return {{"host", toJson(inspectThisHost(plan))}};
    }

    json listen(const json& order) {
        rateListener_.reset();
        auto listener = RateListener::start(order.at("family").get<int>(), order.at("token").get<std::string>(),
                                            order.at("ms").get<int64_t>());
        if (!listener) return {{"port", 0}, {"problem", listener.error().message}};
        rateListener_ = std::move(*listener);
        return {{"port", rateListener_->port()}, {"problem", ""}};
    }

    [[nodiscard]] json troubles() const {
        json list = json::array();
        for (const ProbePath path : kProbePaths) list.push_back(sockets_->trouble(path));
        return list;
    }

    LineChannel lines_;
    std::optional<ProbeSockets> sockets_;
    rsp::GroupOptions options_;
    std::optional<Reading> reading_;
    std::unique_ptr<RateListener> rateListener_;
};

} // namespace

int networkMemberCommand() {
    std::signal(SIGPIPE, SIG_IGN);
    return Member(LineChannel(FileDescriptor(STDIN_FILENO), FileDescriptor(STDOUT_FILENO))).run();
}

} // namespace mural::cli
