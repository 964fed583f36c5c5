#include "nodes/node/node.hpp"

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

#include "common/clock.hpp"
#include "nodes/exchange/picture_composer.hpp"
#include "nodes/exchange/picture_exchange.hpp"
#include "nodes/gl/gl_probe.hpp"
#include "nodes/node/head_line.hpp"
#include "nodes/node/heartbeat.hpp"
#include "nodes/node/tile_windows.hpp"
#include "nodes/placement/placement.hpp"
#include "nodes/replay/replay.hpp"
#include "nodes/session/session_config.hpp"
#include "nodes/session/session_secret.hpp"
#include "nodes/session/stream_build.hpp"
#include "transport/socket_address.hpp"

namespace mural {

namespace {

uint64_t threadCpuNs() { return static_cast<uint64_t>(threadCpuNowNs()); }

double processCpuSeconds() {
    rusage r{};
    getrusage(RUSAGE_SELF, &r);
    return static_cast<double>(r.ru_utime.tv_sec + r.ru_stime.tv_sec) + 1e-6 * static_cast<double>(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

// Near the GPU. Not where the CPU draws: the driver's threads need all cores then.
std::string placeReplay(const NodeSetup& setup, const std::string& renderer) {
    if (!setup.placeThreads) return "not placed: --no-placement";
    for (const char* software : {"llvmpipe", "softpipe", "swrast", "SWR"})
        if (renderer.find(software) != std::string::npos) return "not placed: drawn without a GPU";
    return placeThread(DeviceKind::Gpu).description;
}

std::string hostName() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

constexpr int64_t kMeetMs = 10'000;

class Node {
public:
    Node(std::unique_ptr<HeadLine> line, std::string name) : line_(std::move(line)), name_(std::move(name)) {}

    int run() {
        Heartbeat heartbeat(*line_);
        while (!finished_ && !line_->broken()) {
            std::span<const std::byte> payload;
            const auto header = line_->next(payload);
            if (!header) return finished_ ? 0 : 1; // the head is gone: nothing is left to do
            heartbeat.begins();
            if (!take(header.value(), payload)) return 1;
            heartbeat.ended();
        }
        return line_->broken() ? 1 : 0;
    }

private:
    bool take(const wire::PacketHeader& header, std::span<const std::byte> payload) {
        if (header.stream == 0) return headCommand(payload);
        if (!replay_) return true;
        callsBefore_ = replay_->counts().commands;
        clientInHand_ = wire::clientOf(header.stream);
        if (!replay_->packet(header.stream, payload))
            line_->sendText(wire::NodeMessage::Log, "a broken packet of a program's stream was dropped");
        calls_[clientInHand_] += replay_->counts().commands - callsBefore_;
        callsBefore_ = replay_->counts().commands;
        return true;
    }

    bool headCommand(std::span<const std::byte> payload) {
        uint32_t command = 0;
        if (payload.size() < 4) return false;
        std::memcpy(&command, payload.data(), 4);
        const auto rest = payload.subspan(4);
        switch (static_cast<wire::HeadCommand>(command)) {
        case wire::HeadCommand::Setup: return setUp(std::string(reinterpret_cast<const char*>(rest.data()), rest.size()));
        case wire::HeadCommand::ClientGone: {
            uint32_t client = 0;
            if (rest.size() < 4) return false;
            std::memcpy(&client, rest.data(), 4);
            calls_.erase(client);
            if (replay_) replay_->clientGone(client);
            if (windows_) windows_->clientGone(client);
            sayWindowGone(client, wire::kAllWindows);
            return true;
        }
        case wire::HeadCommand::Exchange: return meet(std::string(reinterpret_cast<const char*>(rest.data()), rest.size()));
        case wire::HeadCommand::Finish:
            sayBye();
            finished_ = true;
            return true;
        }
        return false;
    }

    bool setUp(const std::string& json) {
        const auto setup = nodeSetupFromJson(json);
        if (!setup) return fail(setup.error().message);
        setup_ = setup.value();
        if (setup_.build != streamBuild())
            return fail("the head speaks another stream (" + (setup_.build.empty() ? "unnamed" : setup_.build) + ") than this node (" + streamBuild() + "): install the same version of mural on both machines");
        auto platform = gl::openPlatform(setup_.glBackend);
        if (!platform) return fail(platform.error().message);
        nlohmann::json ready = probe(**platform);
        ready["placement"] = placeReplay(setup_, ready.value("renderer", ""));
        if (!setup_.stream.empty()) {
            const auto followed = line_->follow(setup_.stream, setup_.streamSecret, name_);
            if (!followed) ready["ownStream"] = followed.error().message;
        }
        const char* const plant = std::getenv("MURAL_PLANT");
        if (setup_.economy) {
            const auto unpacks = line_->unpackBatches(static_cast<uint64_t>(setup_.storeBytes), plant ? plant : "");
            if (!unpacks) return fail(unpacks.error().message);
        }
        if (setup_.pass.ranges > 1) {
            if (auto opened = openExchange(ready); !opened) return fail(opened.error().message);
        }
        if (setup_.wallWindows) {
            auto windows = TileWindows::open(setup_);
            if (!windows) return fail(windows.error().message);
            windows_ = std::move(*windows);
        }
        ReplayConfig config;
        config.node = setup_.node;
        config.lean = setup_.tiling == Tiling::Lean;
        config.cull = setup_.tiling == Tiling::Culled;
        config.grid = {setup_.columns, setup_.rows, config.lean ? 2 : 1};
        config.region = {setup_.regionColumn, setup_.regionRow, setup_.regionColumns, setup_.regionRows};
        if (setup_.hasArea) config.area = setup_.area;
        config.pass = setup_.pass;
        config.answers = setup_.answers;
        config.screen = setup_.screen;
        config.eyeBase = setup_.eyeBase;
        config.focusDistance = setup_.focusDistance;
        if (plant) config.plant = plant;
        ReplayOutputs outputs;
        outputs.answer = [this](const wire::AnswerHeader& h, std::span<const std::byte> bytes) {
            line_->send(wire::NodeMessage::Answer, std::as_bytes(std::span(&h, 1)), bytes);
        };
        outputs.frameDone = [this](const ReplayOutputs::Frame& f) { frameDone(f); };
        outputs.windowGone = [this](uint32_t client, uint32_t window) { windowGone(client, window); };
        outputs.news = [this](const wire::News& n, const std::string& text) {
            line_->send(wire::NodeMessage::News, std::as_bytes(std::span(&n, 1)), std::as_bytes(std::span(text)));
        };
        if (composer_) outputs.composeParts = [this](PicturePart& part, const FoldRule& rule) { return composer_->compose(part, rule); };
        outputs.log = [this](const std::string& text) { line_->sendText(wire::NodeMessage::Log, text); };
        replay_ = std::make_unique<Replay>(std::move(*platform), config, std::move(outputs));
        lastCpuNs_ = threadCpuNs();
        line_->sendText(wire::NodeMessage::Ready, ready.dump());
        return true;
    }

    // With the nodes that draw the other ranges of this one's picture.
    Result<void> openExchange(nlohmann::json& ready) {
        const auto secret = sessionSecretFromHex(setup_.exchangeSecret);
        if (!secret) return Error{"the head gave no secret for pictures between nodes: " + secret.error().message};
        ComposerConfig composer;
        const auto strategy = compositor::strategyNamed(setup_.composition);
        if (!strategy) return Error{"the head names a composition that there is not, \"" + setup_.composition + "\": install the same version of mural on both machines"};
        composer.strategy = *strategy;
        composer.rank = setup_.pass.range;
        composer.ranks = setup_.pass.ranges;
        if (const char* plant = std::getenv("MURAL_PLANT")) composer.plant = plant;
        exchange_ = std::make_unique<PictureExchange>(composer.rank, secret.value());
        composer_ = std::make_unique<PictureComposer>(composer, *exchange_, [this](const std::string& text) { line_->sendText(wire::NodeMessage::Log, text); });
        const bool comeHere = composer.rank + 1 < composer.ranks && (composer.rank == 0 || !isStar());
        if (!comeHere) return {};
        if (auto listening = exchange_->listen(setup_.exchangeHere); !listening) return Error{"no pictures of other nodes can be taken: " + listening.error().message};
        ready["exchange"] = endpointText(setup_.exchangeHere ? "127.0.0.1" : line_->ownAddress(), exchange_->port());
        return {};
    }

    // Nodes send to the collector only.
    [[nodiscard]] bool isStar() const { return setup_.composition == compositor::nameOf(compositor::Strategy::Serial); }

    // The nodes with the ranges before this one's; the others come here.
    bool meet(const std::string& text) {
        const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
        const int before = isStar() ? std::min(1, setup_.pass.range) : setup_.pass.range;
        for (int rank = 0; rank < before; ++rank) {
            auto where = splitHostPort(json.is_object() ? json.value(std::to_string(setup_.collector + rank), "") : "");
            if (!where || !exchange_) return fail("the head named no node to send pictures to: install the same version of mural on all machines");
            // No address: it runs where the head does.
            const std::string host = !where->host.empty() ? where->host : line_->headHost().empty() ? "127.0.0.1" : line_->headHost();
            const auto connected = exchange_->connectTo(rank, host, where->port, Deadline::inMs(kMeetMs));
            if (!connected) line_->sendText(wire::NodeMessage::Log, "the node with range " + std::to_string(rank + 1) + " is not reached at " + endpointText(host, where->port) + ": " + connected.error().message + "; what nodes would send each other there is missing");
        }
        return true;
    }

    bool fail(const std::string& why) {
        line_->sendText(wire::NodeMessage::Log, why); // the head says it
        if (line_->broken()) std::cerr << "mural node: " << why << '\n';
        return false;
    }

    // What programs may be promised: what any kind of context offers here.
    static nlohmann::json probe(gl::Platform& platform) {
        nlohmann::json ready;
        ready["host"] = hostName();
        ready["pid"] = getpid();
        std::set<std::string> extensions;
        int best = 0;
        const auto add = [&](gl::Api api, bool core) {
            const auto p = gl::probe(platform, api, core);
            if (!p) return;
            extensions.insert(p.value().extensions.begin(), p.value().extensions.end());
            if (api == gl::Api::Desktop && p.value().glVersion > best) best = p.value().glVersion;
            if (!ready.contains("renderer")) ready["renderer"] = p.value().renderer + ", " + p.value().backend;
        };
        add(gl::Api::Desktop, false);
        add(gl::Api::Desktop, true);
        add(gl::Api::Es2, false);
        add(gl::Api::Es1, false);
        const std::vector<std::string> images = platform.imageExtensions();
        extensions.insert(images.begin(), images.end());
        if (images.empty()) std::erase_if(extensions, [](const std::string& name) { return name.find("_EGL_image") != std::string::npos; });
        ready["glVersion"] = best;
        ready["extensions"] = std::vector<std::string>(extensions.begin(), extensions.end());
        return ready;
    }

    void frameDone(const ReplayOutputs::Frame& f) {
        const uint64_t replayedNs = threadCpuNs();
        if (f.pixels && !f.region.empty()) {
            if (setup_.sendPictures) sendPicture(f, f.pixels(f.region));
            if (windows_) showTiles(f);
        }
        wire::FrameDoneMessage done{};
        done.client = f.client;
        done.window = f.window;
        done.frame = f.frame;
        done.width = f.config.width;
        done.height = f.config.height;
        done.flags = (f.drawnWhole ? wire::kDrawnWhole : 0) | (f.keepsPicture ? wire::kKeepsPicture : 0) | (f.notSplit ? wire::kNotSplit : 0);
        done.replayNs = replayedNs - lastCpuNs_;
        lastCpuNs_ = threadCpuNs();
        done.readbackNs = lastCpuNs_ - replayedNs;
        done.calls = calls_[f.client] + (f.client == clientInHand_ ? replay_->counts().commands - callsBefore_ : 0);
        line_->send(wire::NodeMessage::FrameDone, std::as_bytes(std::span(&done, 1)));
    }

    void windowGone(uint32_t client, uint32_t window) {
        if (windows_) windows_->windowGone(client, window);
        sayWindowGone(client, window);
    }

    void sayWindowGone(uint32_t client, uint32_t window) {
        const wire::WindowGoneMessage gone{client, window};
        line_->send(wire::NodeMessage::WindowGone, std::as_bytes(std::span(&gone, 1)));
    }

    void sendPicture(const ReplayOutputs::Frame& f, const std::byte* pixels) {
        wire::PictureHeader h{};
        h.client = f.client;
        h.window = f.window;
        h.frame = f.frame;
        h.x = f.region.x;
        h.y = f.region.y;
        h.w = f.region.w;
        h.h = f.region.h;
        h.windowWidth = static_cast<uint32_t>(f.picture.w);
        h.windowHeight = static_cast<uint32_t>(f.picture.h);
        h.nativeLow = f.config.nativeLow;
        h.nativeHigh = f.config.nativeHigh;
        line_->send(wire::NodeMessage::Picture, std::as_bytes(std::span(&h, 1)), {pixels, static_cast<size_t>(f.region.area()) * 4});
    }

    void showTiles(const ReplayOutputs::Frame& f) {
        const auto shown = windows_->show(f);
        if (!shown) {
            line_->sendText(wire::NodeMessage::Log, "the wall windows are lost: " + shown.error().message);
            windows_.reset();
        }
    }

    void sayBye() {
        nlohmann::json bye;
        const ReplayCounts counts = replay_ ? replay_->counts() : ReplayCounts{};
        bye["commands"] = counts.commands;
        bye["malformed"] = counts.malformed;
        bye["lacking"] = counts.lacking;
        bye["frames"] = counts.frames;
        bye["cpuSeconds"] = processCpuSeconds();
        if (exchange_) bye["exchangeBytes"] = exchange_->bytesSent();
        line_->sendText(wire::NodeMessage::Bye, bye.dump());
    }

    const std::unique_ptr<HeadLine> line_;
    const std::string name_; // by which the head knows this node
    NodeSetup setup_;
    std::unique_ptr<TileWindows> windows_;
    std::unique_ptr<Replay> replay_;
    uint64_t lastCpuNs_ = 0;
    std::map<uint32_t, uint64_t> calls_; // by client, of packets that are done with
    uint32_t clientInHand_ = 0;          // whose packet was taken last…
    uint64_t callsBefore_ = 0;           // …and the records of all clients before it
    bool finished_ = false;
    std::unique_ptr<PictureExchange> exchange_; // null: no other node has a part of this one's picture
    std::unique_ptr<PictureComposer> composer_; // by it
};

} // namespace

int runNode(const NodeOptions& options) {
    auto line = HeadLine::open(options);
    if (!line) {
        std::cerr << "mural node: " << line.error().message << '\n';
        return 1;
    }
    return Node(std::move(*line), options.name).run();
}

} // namespace mural
