#include "nodes/render/node.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

#include "common/base/clock.hpp"
#include "common/base/pause_watch.hpp"
#include "common/log/log.hpp"
#include "common/log/process_log.hpp"
#include "nodes/exchange/picture_composer.hpp"
#include "nodes/exchange/picture_exchange.hpp"
#include "nodes/gl/gl_probe.hpp"
#include "nodes/gl/software_renderer.hpp"
#include "nodes/render/barrier_part.hpp"
#include "nodes/render/head_connection.hpp"
#include "nodes/render/heartbeat.hpp"
#include "nodes/render/tile_windows.hpp"
#include "nodes/frame_transfer/picture_sender.hpp"
#include "nodes/affinity/placement.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/session/session_config.hpp"
#include "nodes/session/session_secret.hpp"
#include "nodes/session/stream_build.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

namespace {

uint64_t threadCpuNs() { return static_cast<uint64_t>(threadCpuNowNs()); }

double processCpuSeconds() {
    rusage r{};
    getrusage(RUSAGE_SELF, &r);
    return static_cast<double>(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

// Places the replay thread near the GPU. Not with software rendering, because the driver's threads then need all cores.
std::string placeReplay(const NodeSetup& setup, const std::string& renderer) {
    if (!setup.placeThreads) return "not placed: --no-placement";
    if (gl::drawsWithoutGpu(renderer)) return "not placed: no GPU draws";
    return placeThread(DeviceKind::Gpu).description;
}

std::string hostName() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

std::vector<Viewport> areasOf(const std::vector<double>& numbers) {
    std::vector<Viewport> areas;
    for (size_t i = 0; i + 4 <= numbers.size(); i += 4)
        areas.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
    return areas;
}

int64_t processCpuNowNs() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return int64_t{now.tv_sec} * kNsPerS + now.tv_nsec;
}

constexpr int64_t kConnectNodesMs = 10'000;
constexpr int64_t kSlower = 2;  // planted fault: additional time, as a multiple of the work's time
constexpr int kLostPacket = 10; // planted fault: index of the packet that a node in resync drops

class Node {
public:
    Node(std::unique_ptr<HeadConnection> line, std::string name) : line_(std::move(line)), name_(std::move(name)) {}

    int run() {
        Heartbeat heartbeat(*line_);
        while (!finished_ && !line_->broken()) {
            std::span<const std::byte> payload;
            const auto header = line_->next(payload);
            if (!header) return finished_ ? 0 : 1; // the connection to the head is lost
            heartbeat.begins();
            if (!take(header.value(), payload)) return 1;
            heartbeat.ended();
        }
        return line_->broken() ? 1 : 0;
    }

private:
    bool take(const wire::PacketHeader& header, std::span<const std::byte> payload) {
        beganNs_ = workNowNs();
        const bool goesOn = takePacket(header, payload);
        countWork();
        return goesOn;
    }

    // Adds the time since beganNs_ to the work. Called before a wait, because waits do not count.
    void countWork() {
        const int64_t nowNs = workNowNs();
        // the difference of two clocks may decrease
        const int64_t workedNs = std::max<int64_t>(nowNs - std::exchange(beganNs_, nowNs), 0);
        if (slow_) std::this_thread::sleep_for(std::chrono::nanoseconds(kSlower * workedNs));
        busyNs_ += workedNs * (slow_ ? 1 + kSlower : 1);
    }

    // Returns the CPU time of this process if nodes share the cores of a machine, otherwise the time. Nodes on the same
    // cores delay each other regardless of their tiles, so only their own work counts there. The CPU time of the
    // picture thread is excluded, because PictureSender adds it to the frames.
    [[nodiscard]] int64_t workNowNs() const {
        return countsCpu_ ? processCpuNowNs() - (sender_ ? sender_->cpuNs() : 0) : monotonicNowNs();
    }

    // Sends a message to the head, in order with pictures.
    void sendMessage(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {}) {
        if (!sender_) return line_->send(type, a, b);
        stuck_ = !sender_->enqueue(type, a, b) || stuck_;
    }

    bool takePacket(const wire::PacketHeader& header, std::span<const std::byte> payload) {
        if (header.stream == 0) return headCommand(payload);
        if (!replay_) return true;
        if (losesPackets_ && catchesUp_ && ++packetsGiven_ == kLostPacket) return true;
        callsBefore_ = replay_->counts().commands;
        clientInHand_ = wire::clientOf(header.stream);
        if (!replay_->packet(header.stream, payload))
            log::warning(log::Topic::Stream, "an invalid packet of a program's stream was dropped");
        calls_[clientInHand_] += replay_->counts().commands - callsBefore_;
        callsBefore_ = replay_->counts().commands;
        return !invalid_ && !stuck_;
    }

    bool headCommand(std::span<const std::byte> payload) {
        uint32_t command = 0;
        if (payload.size() < 4) return false;
        std::memcpy(&command, payload.data(), 4);
        const auto rest = payload.subspan(4);
        switch (static_cast<wire::HeadCommand>(command)) {
        case wire::HeadCommand::Setup:
            return setUp(std::string(reinterpret_cast<const char*>(rest.data()), rest.size()));
        case wire::HeadCommand::ClientGone: {
            uint32_t client = 0;
            if (rest.size() < 4) return false;
            std::memcpy(&client, rest.data(), 4);
            calls_.erase(client);
            frames_.erase(client);
            if (replay_) replay_->clientGone(client);
            if (windows_) windows_->clientGone(client);
            if (sender_) sender_->clientGone(client);
            std::erase_if(eightBitsReported_, [client](const auto& window) { return window.first == client; });
            reportWindowGone(client, wire::kAllWindows);
            return true;
        }
        case wire::HeadCommand::Activate: return newMember(rest);
        case wire::HeadCommand::ResetDictionary: return unpackBatches();
        case wire::HeadCommand::RequestPhase: return sendPhaseState(rest);
        case wire::HeadCommand::Turns: return takeTurns(rest);
        case wire::HeadCommand::JoinMulticast: return joinGroup(rest);
        case wire::HeadCommand::SwitchToMulticast: return changeOver(rest);
        case wire::HeadCommand::ViewportAssignment: return moveAreas(rest);
        case wire::HeadCommand::RangeAssignment: return moveShares(rest);
        case wire::HeadCommand::Synchronize: return synchronize(rest);
        case wire::HeadCommand::Exchange:
            return connectNodes(std::string(reinterpret_cast<const char*>(rest.data()), rest.size()));
        case wire::HeadCommand::Finish:
            log::debug(log::Topic::Node, "the session ends");
            sendGoodbye();
            finished_ = true;
            return true;
        }
        return false;
    }

    bool setUp(const std::string& json) {
        const auto setup = nodeSetupFromJson(json);
        if (!setup) return fail(setup.error().message);
        setup_ = setup.value();
        openLog();
        catchesUp_ = setup_.isResyncing;
        if (setup_.build != streamBuild())
            return fail("the head uses another stream format (" + (setup_.build.empty() ? "unnamed" : setup_.build) +
                        ") than this node (" + streamBuild() + "): install the same version of mural on both machines");
        auto platform = gl::openPlatform(setup_.glBackend);
        if (!platform) return fail(platform.error().message);
        nlohmann::json ready = probe(**platform);
        countsCpu_ = setup_.sharesMachine && gl::drawsWithoutGpu(ready.value("renderer", ""));
        beganNs_ = workNowNs();
        ready["placement"] = placeReplay(setup_, ready.value("renderer", ""));
        if (!setup_.stream.empty() && !setup_.isResyncing) {
            const auto followed = line_->follow(setup_.stream, setup_.streamSecret, name_);
            if (!followed) ready["ownStream"] = followed.error().message;
        }
        const char* const plant = std::getenv("MURAL_PLANT");
        if (setup_.delta) {
            if (!unpackBatches()) return false;
        }
        if (setup_.pass.ranges > 1) {
            if (auto opened = openExchange(ready); !opened) return fail(opened.error().message);
        }
        if (setup_.swapMembers > 1) {
            if (auto opened = openBarrier(ready); !opened) return fail(opened.error().message);
        }
        if (setup_.wallWindows) {
            auto windows = TileWindows::open(setup_);
            if (!windows) return fail(windows.error().message);
            windows_ = std::move(*windows);
        }
        if (setup_.sendPictures) openSender();
        ReplayConfig config;
        config.node = setup_.node;
        config.skips = setup_.isResyncing && setup_.skipsFrames;
        config.isResyncing = setup_.isResyncing;
        config.lean = setup_.tiling == Tiling::Lean;
        config.cull = setup_.tiling == Tiling::Culled;
        config.rastersInBins = gl::drawsWithoutGpu(ready.value("renderer", ""));
        config.grid = {setup_.columns, setup_.rows, config.lean ? 2 : 1};
        config.region = {setup_.regionColumn, setup_.regionRow, setup_.regionColumns, setup_.regionRows};
        if (setup_.hasArea) config.area = setup_.area;
        if (!setup_.areas.empty()) config.areas.emplace(ViewportAssignment{0, areasOf(setup_.areas)});
        config.pass = setup_.pass;
        config.readback =
            setup_.sendPictures ? readbackBy(ready.value("renderer", ""), setup_.readback) : Readback::Direct;
        config.deepPictures = setup_.deepPictures;
        config.answers = setup_.answers;
        config.screen = setup_.screen;
        config.eyeBase = setup_.eyeBase;
        config.focusDistance = setup_.focusDistance;
        if (plant) config.plant = plant;
        losesPackets_ = config.plant == "rejoin";
        slow_ = config.plant == "slow" && setup_.node == 1;
        ReplayOutputs outputs;
        outputs.answer = [this](const wire::ReplyPartHeader& h, std::span<const std::byte> bytes) {
            if (!catchesUp_ && !invalid_)
                sendMessage(wire::NodeMessage::ReplyPart, std::as_bytes(std::span(&h, 1)), bytes);
        };
        outputs.frameDone = [this](const ReplayOutputs::Frame& f) { frameDone(f); };
        outputs.invalid = [this] { invalid(); };
        outputs.windowGone = [this](uint32_t client, uint32_t window) { windowGone(client, window); };
        outputs.driverEvent = [this](const wire::DriverEvent& n, const std::string& text) {
            if (!catchesUp_)
                sendMessage(wire::NodeMessage::DriverEvent, std::as_bytes(std::span(&n, 1)),
                            std::as_bytes(std::span(text)));
        };
        if (composer_)
            outputs.composeParts = [this](PicturePart& part, const CompositeRule& rule) {
                return composer_->compose(part, rule);
            };
        replay_ = std::make_unique<Replay>(std::move(*platform), config, std::move(outputs));
        lastCpuNs_ = threadCpuNs();
        log::debug(log::Topic::Node, setup_.isResyncing ? "restarted, " : "", "draws with ",
                   ready.value("renderer", "no GL"));
        log::debug(log::Topic::Affinity, "thread of the replay: ", ready.value("placement", ""));
        line_->sendText(wire::NodeMessage::Ready, ready.dump());
        return true;
    }

    // MURAL_LOG of this machine precedes the head's.
    void openLog() {
        log::setRole("node " + std::to_string(setup_.node));
        if (!log::environmentLevels().empty()) return;
        if (const auto levels = log::parseLevels(setup_.log)) log::setLevels(levels.value());
    }

    Result<void> openBarrier(nlohmann::json& ready) {
        swaps_ = std::make_unique<BarrierPart>(setup_);
        auto port = swaps_->open();
        if (!port) return port.error();
        if (*port != 0) ready["swapBarrier"] = endpointText(setup_.swapHere ? "127.0.0.1" : line_->ownAddress(), *port);
        return {};
    }

    // Starts with an empty dictionary.
    bool unpackBatches() {
        const char* const plant = std::getenv("MURAL_PLANT");
        const auto unpacks = line_->unpackBatches(static_cast<uint64_t>(setup_.cacheBytes), plant ? plant : "");
        return unpacks || fail(unpacks.error().message);
    }

    // Opens the exchange with the nodes that draw the other ranges of the same picture.
    Result<void> openExchange(nlohmann::json& ready) {
        const auto secret = sessionSecretFromHex(setup_.exchangeSecret);
        if (!secret)
            return Error{"the head sent an invalid secret for the picture exchange: " + secret.error().message};
        ComposerConfig composer;
        const auto strategy = compositor::strategyNamed(setup_.composition);
        if (!strategy)
            return Error{"the head sent the unknown composition \"" + setup_.composition +
                         "\"; install the same version of mural on both machines"};
        composer.strategy = *strategy;
        composer.rank = setup_.pass.range;
        composer.ranks = setup_.pass.ranges;
        composer.codec = setup_.partCodec;
        if (const char* plant = std::getenv("MURAL_PLANT")) composer.plant = plant;
        exchange_ =
            std::make_unique<PictureExchange>(PictureExchange::Name{composer.rank, setup_.incarnation}, secret.value());
        composer_ = std::make_unique<PictureComposer>(composer, *exchange_);
        // Every node listens, even one without initial peers: a restarted node connects to those present.
        if (auto listening = exchange_->listen(setup_.exchangeHere); !listening)
            return Error{"cannot listen for pictures of other nodes: " + listening.error().message};
        ready["exchange"] = endpointText(setup_.exchangeHere ? "127.0.0.1" : line_->ownAddress(), exchange_->port());
        return {};
    }

    // Returns whether nodes send to the collector only.
    [[nodiscard]] bool isStar() const { return setup_.composition == compositor::nameOf(compositor::Strategy::Serial); }

    // Returns whether this node opens the connection to the node of `rank`. Nodes connect to all lower ranks and accept
    // connections of higher ones. A restarted node connects to all.
    [[nodiscard]] bool goesTo(int rank) const {
        const int own = setup_.pass.range;
        return rank != own && (setup_.isResyncing || rank < own) && (!isStar() || rank == 0 || own == 0);
    }

    bool connectNodes(const std::string& text) {
        const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
        for (int rank = 0; exchange_ && rank < setup_.pass.ranges; ++rank) {
            if (!goesTo(rank)) continue;
            const auto where = addressIn(json, "pictures", setup_.collector + rank);
            if (!where && setup_.isResyncing) continue; // that node is lost or not ready
            if (!where)
                return fail("the head sent no addresses for the picture exchange; install the same version of mural on "
                            "all machines");
            const auto connected =
                exchange_->connectTo(rank, where->host, where->port, Deadline::inMs(kConnectNodesMs));
            if (!connected)
                log::warning(log::Topic::Exchange, "cannot connect to the node with range ", rank + 1, " at ",
                             endpointText(where->host, where->port), ": ", connected.error().message,
                             "; their parts of the picture are missing");
        }
        if (!swaps_ || setup_.swapRank == 0) return true;
        const auto leader = addressIn(json, "swaps", setup_.swapLeader);
        if (!leader)
            return fail("the head sent no address of the swap barrier's leader; install the same version of mural on "
                        "all machines");
        swaps_->follow(leader->host, leader->port);
        return true;
    }

    // Returns the address at which `node` listens. Without a host it runs on the head's machine.
    [[nodiscard]] std::optional<HostPort> addressIn(const nlohmann::json& all, const char* what, int node) const {
        const auto found = all.is_object() ? all.find(what) : all.end();
        if (found == all.end() || !found->is_object()) return std::nullopt;
        auto where = splitHostPort(found->value(std::to_string(node), ""));
        if (!where) return std::nullopt;
        if (where->host.empty()) where->host = line_->headHost().empty() ? "127.0.0.1" : line_->headHost();
        return *where;
    }

    // Sends the reason even if its level is off, because the head uses it.
    bool fail(const std::string& why) {
        line_->sendText(wire::NodeMessage::Log, why);
        if (line_->broken()) log::error(log::Topic::Node, why);
        return false;
    }

    // Returns the capabilities that programs can use: the extensions of every kind of context here.
    static nlohmann::json probe(gl::Platform& platform) {
        nlohmann::json ready;
        ready["host"] = hostName();
        ready["pid"] = getpid();
        std::set<std::string> extensions;
        int best = 0, maxPixels = 0;
        const auto add = [&](gl::Api api, bool core) {
            const auto p = gl::probe(platform, api, core);
            if (!p) return;
            extensions.insert(p.value().extensions.begin(), p.value().extensions.end());
            if (api == gl::Api::Desktop && p.value().glVersion > best) best = p.value().glVersion;
            if (maxPixels == 0 || p.value().maxSurfaceSize < maxPixels) maxPixels = p.value().maxSurfaceSize;
            const std::string &renderer = p.value().renderer, &backend = p.value().backend;
            if (!ready.contains("renderer"))
                ready["renderer"] = backend.find(renderer) != std::string::npos ? backend : renderer + ", " + backend;
        };
        add(gl::Api::Desktop, false);
        add(gl::Api::Desktop, true);
        add(gl::Api::Es2, false);
        add(gl::Api::Es1, false);
        const std::vector<std::string> images = platform.imageExtensions();
        extensions.insert(images.begin(), images.end());
        if (images.empty())
            std::erase_if(extensions,
                          [](const std::string& name) { return name.find("_EGL_image") != std::string::npos; });
        ready["glVersion"] = best;
        ready["maxPixels"] = maxPixels;
        ready["extensions"] = std::vector<std::string>(extensions.begin(), extensions.end());
        return ready;
    }

    bool synchronize(std::span<const std::byte> arguments) {
        uint32_t words[2] = {};
        if (arguments.size() < sizeof words) return false;
        std::memcpy(words, arguments.data(), sizeof words);
        if (words[1] != 0 && replay_) replay_->drawAgain();
        const wire::SynchronizedMessage done{
            words[0], static_cast<uint32_t>(replay_ ? replay_->validity() : wire::FrameValidity::Valid)};
        sendMessage(wire::NodeMessage::Synchronized, std::as_bytes(std::span(&done, 1)));
        return true;
    }

    // Ends this node, because it has skipped frames that its pictures depend on. No picture of it is shown from now on.
    void invalid() {
        if (catchesUp_ || std::exchange(invalid_, true)) return;
        log::warning(log::Topic::Node, "its frames depend on earlier frames that it skipped while it caught "
                                       "up; it ends and is restarted to draw all frames");
    }

    // A node becomes a member. If it is this node, other nodes have sent all earlier messages.
    bool newMember(std::span<const std::byte> arguments) {
        uint32_t words[4] = {};
        if (arguments.size() < sizeof words) return false;
        std::memcpy(words, arguments.data(), sizeof words);
        const uint32_t view = words[0], node = words[1], incarnation = words[3];
        const bool itself = node == static_cast<uint32_t>(setup_.node);
        if (words[2] != 0 && replay_) {
            replay_->beginTurns();
            replay_->beginAreas();
        }
        shareWith(static_cast<int>(node), incarnation, arguments.subspan(sizeof words));
        if (catchesUp_ && !itself) return true;
        if (std::exchange(catchesUp_, false)) busyNs_ = 0; // the resync is no frame's work
        log::debug(log::Topic::Node, "view ", view, ": node ", node, " is a member");
        std::vector<wire::ClientFrame> frames;
        for (const auto& [client, frame] : frames_) frames.push_back({client, frame});
        sendMessage(wire::NodeMessage::ViewReached, std::as_bytes(std::span(&view, 1)),
                    std::as_bytes(std::span(frames)));
        return true;
    }

    // Composes with `node` from now on, and without the ranks of `absent`. No effect unless it draws a range of the
    // same picture.
    void shareWith(int node, uint32_t incarnation, std::span<const std::byte> absent) {
        const auto rankOf = [this](int other) {
            return other >= setup_.collector && other < setup_.collector + setup_.pass.ranges ? other - setup_.collector
                                                                                              : -1;
        };
        if (!composer_ || !replay_ || rankOf(node) < 0) return;
        std::set<int> absentRanks;
        for (; absent.size() >= sizeof(uint32_t); absent = absent.subspan(sizeof(uint32_t))) {
            uint32_t other = 0;
            std::memcpy(&other, absent.data(), sizeof other);
            if (const int rank = rankOf(static_cast<int>(other)); rank >= 0) absentRanks.insert(rank);
        }
        replay_->resetShares(node == setup_.node, [this, rank = rankOf(node), incarnation, absentRanks] {
            composer_->returned(rank, incarnation, absentRanks);
        });
    }

    bool sendPhaseState(std::span<const std::byte> number) {
        if (number.size() < sizeof(uint32_t)) return false;
        if (catchesUp_ || !replay_) return true;
        if (!setup_.areas.empty()) {
            sendMessage(wire::NodeMessage::Turns, number.first(sizeof(uint32_t)), replay_->memberAreas());
        } else if (setup_.pass.period > 1) {
            const std::vector<wire::WindowTurn> turns = replay_->turns();
            sendMessage(wire::NodeMessage::Turns, number.first(sizeof(uint32_t)), std::as_bytes(std::span(turns)));
        }
        return true;
    }

    bool moveAreas(std::span<const std::byte> bytes) {
        auto areas = takeAreas(bytes);
        if (!areas || !bytes.empty()) return false;
        if (replay_) replay_->moveAreas(std::move(*areas));
        return true;
    }

    bool moveShares(std::span<const std::byte> bytes) {
        const auto shares = sharesOf(bytes);
        if (shares && replay_) replay_->moveShares(*shares);
        return shares.has_value();
    }

    bool takeTurns(std::span<const std::byte> bytes) {
        if (!setup_.areas.empty()) return !replay_ || replay_->takeMemberAreas(bytes);
        if (bytes.size() % sizeof(wire::WindowTurn) != 0) return false;
        std::vector<wire::WindowTurn> turns(bytes.size() / sizeof(wire::WindowTurn));
        if (!bytes.empty()) std::memcpy(turns.data(), bytes.data(), bytes.size());
        if (replay_) replay_->takeTurns(turns);
        return true;
    }

    bool joinGroup(std::span<const std::byte> arguments) {
        uint32_t node = 0;
        if (arguments.size() < sizeof node) return false;
        std::memcpy(&node, arguments.data(), sizeof node);
        if (node == static_cast<uint32_t>(setup_.node)) line_->joinBeside(setup_.stream, setup_.streamSecret, name_);
        return true;
    }

    bool changeOver(std::span<const std::byte> arguments) {
        wire::SwitchToMulticastCommand command{};
        if (arguments.size() < sizeof command) return false;
        std::memcpy(&command, arguments.data(), sizeof command);
        if (command.node != static_cast<uint32_t>(setup_.node)) return true;
        const auto changed = line_->changeOver(uint64_t{command.skipHigh} << 32 | command.skipLow);
        return changed || fail("its stream cannot switch to multicast: " + changed.error().message);
    }

    // Reports a window whose picture loses bits, once, on the first node.
    void reportEightBits(const ReplayOutputs::Frame& f) {
        const bool shows = setup_.node == 0 && (sender_ || windows_);
        if (!shows || f.config.red <= 8 || f.format != PictureFormat::Bgra8 ||
            !eightBitsReported_.insert({f.client, f.window}).second)
            return;
        log::warning(log::Topic::Picture, "the program's window has ", f.config.red,
                     " bits per channel; its picture is shown and saved with 8; replies to the program have all bits");
    }

    void frameDone(const ReplayOutputs::Frame& f) {
        uint32_t& latest = frames_[f.client];
        latest = std::max(latest, f.frame);
        if (!f.valid) invalid();
        if (catchesUp_ || invalid_) return;
        const uint64_t replayedNs = threadCpuNs();
        std::unique_ptr<PictureRead> picture;
        if (f.pixels && !f.region.empty()) {
            reportEightBits(f);
            if (sender_) picture = f.read();
            countWork();
            if (windows_) showTiles(f);
            beganNs_ = workNowNs(); // excludes a wait for the barrier or the display
        }
        countWork();
        wire::FrameDoneMessage done{};
        done.client = f.client;
        done.window = f.window;
        done.frame = f.frame;
        done.width = f.config.width;
        done.height = f.config.height;
        done.flags = (f.drawnWhole ? wire::kDrawnWhole : 0) | (f.keepsPicture ? wire::kKeepsPicture : 0) |
                     (f.notSplit ? wire::kNotSplit : 0) | (f.keepsAreas ? wire::kKeepsAreas : 0);
        done.areas = f.areas;
        done.shares = f.shares;
        done.busyNs = static_cast<uint64_t>(std::exchange(busyNs_, 0));
        done.replayNs = replayedNs - lastCpuNs_;
        lastCpuNs_ = threadCpuNs();
        done.readbackNs = lastCpuNs_ - replayedNs;
        done.calls = calls_[f.client] + (f.client == clientInHand_ ? replay_->counts().commands - callsBefore_ : 0);
        if (!picture) return sendMessage(wire::NodeMessage::FrameDone, std::as_bytes(std::span(&done, 1)));
        stuck_ = !sender_->send({headerOf(f), std::move(picture), done}) || stuck_;
        beganNs_ = workNowNs(); // excludes a wait for queue space
    }

    void windowGone(uint32_t client, uint32_t window) {
        if (windows_) windows_->windowGone(client, window);
        if (sender_) sender_->windowGone(client, window);
        eightBitsReported_.erase({client, window});
        reportWindowGone(client, window);
    }

    void reportWindowGone(uint32_t client, uint32_t window) {
        if (catchesUp_) return;
        const wire::WindowGoneMessage gone{client, window};
        sendMessage(wire::NodeMessage::WindowGone, std::as_bytes(std::span(&gone, 1)));
    }

    static wire::PictureHeader headerOf(const ReplayOutputs::Frame& f) {
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
        h.format = static_cast<uint32_t>(f.format);
        return h;
    }

    void openSender() {
        PictureSenderConfig config;
        config.codec = setup_.pictureCodec;
        config.addsCpu = countsCpu_;
        config.transferScale = setup_.transferScale;
        config.alpha = setup_.windowPixels ? PictureAlpha::Preserved : PictureAlpha::Dropped;
        const auto send = [this](wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
            line_->send(type, a, b);
        };
        sender_ = std::make_unique<PictureSender>(config, send);
        beganNs_ = workNowNs(); // the sender's clock starts now
    }

    void showTiles(const ReplayOutputs::Frame& f) {
        const auto shown = windows_->show(f, swaps_ ? swaps_->barrier() : nullptr);
        if (!shown) {
            log::warning(log::Topic::Output, "the wall windows are lost: ", shown.error().message);
            windows_.reset();
        }
    }

    void sendGoodbye() {
        nlohmann::json bye;
        if (sender_ && !sender_->finish()) return; // the sender has logged the reason
        const ReplayCounts counts = replay_ ? replay_->counts() : ReplayCounts{};
        bye["commands"] = counts.commands;
        bye["malformed"] = counts.malformed;
        bye["lacking"] = counts.lacking;
        bye["frames"] = counts.frames;
        bye["cpuSeconds"] = processCpuSeconds();
        if (exchange_) bye["exchangeBytes"] = exchange_->bytesSent();
        if (sender_ && sender_->packs()) {
            bye["pictureBytes"] = sender_->packedBytes();
            bye["pictureRawBytes"] = sender_->rawBytes();
        }
        if (const auto numbers = swaps_ && swaps_->barrier() ? swaps_->barrier()->numbers() : std::nullopt)
            bye["swapBarrier"] = {{"members", setup_.swapMembers},      {"swaps", numbers->skew.swaps},
                                  {"medianNs", numbers->skew.medianNs}, {"p99Ns", numbers->skew.p99Ns},
                                  {"maxNs", numbers->skew.maxNs},       {"clockErrorNs", numbers->clockErrorNs}};
        line_->sendText(wire::NodeMessage::Goodbye, bye.dump());
    }

    // Sends log lines for the user to the head.
    bool report(std::string_view text) {
        line_->sendText(wire::NodeMessage::Log, std::string(text));
        return !line_->broken();
    }

    const std::unique_ptr<HeadConnection> line_;
    const log::Receiver lines_{log::Level::Info,
                               [this](log::Topic, log::Level, std::string_view text) { return report(text); }};
    const std::string name_; // identifies this node to the head
    NodeSetup setup_;
    std::unique_ptr<BarrierPart> swaps_; // null: no swap barrier
    std::unique_ptr<TileWindows> windows_;
    std::unique_ptr<Replay> replay_;
    std::unique_ptr<PictureSender> sender_; // null: the head requests no pictures
    bool stuck_ = false;                    // the sender failed: no message leaves this node
    uint64_t lastCpuNs_ = 0;
    bool countsCpu_ = false;
    int64_t beganNs_ = 0;                                       // workNowNs() at the start of the current work
    int64_t busyNs_ = 0;                                        // completed work since the last frame
    bool slow_ = false;                                         // planted fault
    std::map<uint32_t, uint64_t> calls_;                        // commands by client, in completed packets
    std::map<uint32_t, uint32_t> frames_;                       // latest frame by client
    std::set<std::pair<uint32_t, uint32_t>> eightBitsReported_; // client, window
    bool invalid_ = false;                                      // this node can't draw the picture of the others
    bool losesPackets_ = false;                                 // planted fault
    int packetsGiven_ = 0;                                      // packets received during the resync
    bool catchesUp_ = false;    // in resync: replays commands whose messages the head has from other nodes
    uint32_t clientInHand_ = 0; // client of the current or latest packet
    uint64_t callsBefore_ = 0;  // commands of all clients before that packet
    bool finished_ = false;
    std::unique_ptr<PictureExchange> exchange_; // null: this node draws all ranges of its picture
    std::unique_ptr<PictureComposer> composer_; // by it
};

} // namespace

int runNode(const NodeOptions& options) {
    signal(SIGPIPE, SIG_IGN); // the end of a display is an error of its windows and must not end the node
    const PauseWatch pauseWatch;
    auto line = HeadConnection::open(options);
    if (!line) {
        log::error(log::Topic::Node, line.error().message);
        return 1;
    }
    return Node(std::move(*line), options.name).run();
}

} // namespace mural
