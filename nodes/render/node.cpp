#include "nodes/render/node.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "common/json/json_text.hpp"
#include "common/base/clock.hpp"
#include "common/base/pause_watch.hpp"
#include "common/log/log.hpp"
#include "common/log/process_log.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/gl/software_renderer.hpp"
#include "nodes/render/barrier_part.hpp"
#include "nodes/render/command_arguments.hpp"
#include "nodes/render/exchange_part.hpp"
#include "nodes/render/frame_messages.hpp"
#include "nodes/render/goodbye.hpp"
#include "nodes/render/head_connection.hpp"
#include "nodes/render/heartbeat.hpp"
#include "nodes/render/lost_bits_notice.hpp"
#include "nodes/render/node_description.hpp"
#include "nodes/render/output_proof.hpp"
#include "nodes/render/player_config.hpp"
#include "nodes/render/replay_spans.hpp"
#include "nodes/render/windows/preview_sender.hpp"
#include "nodes/input/input_event_bytes.hpp"
#include "nodes/render/windows/tile_windows.hpp"
#include "nodes/render/work_clock.hpp"
#include "nodes/frame_transfer/picture_sender.hpp"
#include "nodes/session/session_config.hpp"
#include "nodes/session/stream_build.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

namespace {

uint64_t threadCpuNs() { return static_cast<uint64_t>(threadCpuNowNs()); }

constexpr int64_t kSlower = 2;  // planted fault: additional time, as a multiple of the work's time
constexpr int kLostPacket = 10; // planted fault: index of the packet that a node in resync drops

class Node {
public:
    Node(std::unique_ptr<HeadConnection> line, std::string name, MakePlayer makePlayer)
        : line_(std::move(line)), name_(std::move(name)), makePlayer_(std::move(makePlayer)) {}

    int run() {
        Heartbeat heartbeat(*line_);
        while (!finished_ && !line_->broken()) {
            std::span<const std::byte> payload;
            std::optional<AheadPacket> ahead;
            if (!ahead_.empty()) {
                ahead = std::move(ahead_.front());
                ahead_.pop_front();
            }
            const auto header = ahead ? Result<wire::PacketHeader>(ahead->header) : line_->next(payload);
            if (!header) return finished_ ? 0 : 1; // the connection to the head is lost
            heartbeat.begins();
            if (!take(header.value(), ahead ? std::span<const std::byte>(ahead->payload) : payload)) return 1;
            heartbeat.ended();
        }
        return line_->broken() ? 1 : 0;
    }

private:
    // A packet that was read while the player played an earlier one.
    struct AheadPacket {
        wire::PacketHeader header;
        std::vector<std::byte> payload;
    };

    // Reads a packet for PlayerOutputs::readAhead.
    ReadAhead readAhead(Deadline deadline) {
        std::span<const std::byte> payload;
        work_.pause();
        auto header = line_->nextBefore(payload, deadline);
        work_.begin();
        if (!header) return ReadAhead::Ended;
        if (!header.value()) return ReadAhead::Nothing;
        const std::vector<std::byte> own(payload.begin(), payload.end());
        if (header.value()->stream != 0) {
            ahead_.push_back({*header.value(), own});
            player_->preview(header.value()->stream, own);
            return ReadAhead::Received;
        }
        const auto command = argument<uint32_t>(own);
        if (!command) return ReadAhead::Ended;
        switch (static_cast<wire::HeadCommand>(*command)) {
        // These change how the following packets are read.
        case wire::HeadCommand::ResetDictionary:
        case wire::HeadCommand::JoinMulticast:
        case wire::HeadCommand::SwitchToMulticast: return headCommand(own) ? ReadAhead::Received : ReadAhead::Ended;
        default: break;
        }
        ahead_.push_back({*header.value(), own});
        return endsPlay(static_cast<wire::HeadCommand>(*command), std::span(own).subspan(sizeof *command))
                   ? ReadAhead::Ended
                   : ReadAhead::Received;
    }

    // Whether the program of the current frame, or this node, is at its end.
    [[nodiscard]] bool endsPlay(wire::HeadCommand command, std::span<const std::byte> arguments) const {
        const auto number = argument<uint32_t>(arguments);
        switch (command) {
        case wire::HeadCommand::Finish: return true;
        case wire::HeadCommand::ClientGone: return number && *number == clientInHand_;
        case wire::HeadCommand::Leave: return number && *number == static_cast<uint32_t>(setup_.node);
        default: return false;
        }
    }

    bool take(const wire::PacketHeader& header, std::span<const std::byte> payload) {
        work_.begin();
        const bool goesOn = takePacket(header, payload);
        work_.pause();
        return goesOn;
    }

    // Sends a message to the head, in order with pictures.
    void sendMessage(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {}) {
        if (!sender_) return line_->send(type, a, b);
        stuck_ = !sender_->enqueue(type, a, b) || stuck_;
    }

    bool takePacket(const wire::PacketHeader& header, std::span<const std::byte> payload) {
        if (header.stream == 0) return headCommand(payload);
        if (!player_) return true;
        if (losesPackets_ && catchesUp_ && ++packetsGiven_ == kLostPacket) return true;
        callsBefore_ = player_->counts().commands;
        clientInHand_ = wire::clientOf(header.stream);
        if (!player_->packet(header.stream, payload))
            log::warning(log::Topic::Stream, "an invalid packet of a program's stream was dropped");
        calls_[clientInHand_] += player_->counts().commands - callsBefore_;
        callsBefore_ = player_->counts().commands;
        return !invalid_ && !stuck_;
    }

    bool headCommand(std::span<const std::byte> payload) {
        const auto command = argument<uint32_t>(payload);
        if (!command) return false;
        const auto rest = payload.subspan(sizeof *command);
        switch (static_cast<wire::HeadCommand>(*command)) {
        case wire::HeadCommand::Setup:
            return setUp(std::string(reinterpret_cast<const char*>(rest.data()), rest.size()));
        case wire::HeadCommand::ClientGone: {
            const auto client = argument<uint32_t>(rest);
            if (client) clientGone(*client);
            return client.has_value();
        }
        case wire::HeadCommand::Activate: return newMember(rest);
        case wire::HeadCommand::ResetDictionary: return decodeBatches();
        case wire::HeadCommand::RequestPhase: return sendPhaseState(rest);
        case wire::HeadCommand::Turns: return takeTurns(rest);
        case wire::HeadCommand::JoinMulticast: return joinGroup(rest);
        case wire::HeadCommand::SwitchToMulticast: return changeOver(rest);
        case wire::HeadCommand::ViewportAssignment: return moveAreas(rest);
        case wire::HeadCommand::RangeAssignment: return moveShares(rest);
        case wire::HeadCommand::Synchronize: return synchronize(rest);
        case wire::HeadCommand::Exchange:
            return connectNodes(std::string(reinterpret_cast<const char*>(rest.data()), rest.size()));
        case wire::HeadCommand::Statistics: return spans_.record(rest);
        case wire::HeadCommand::ClockProbe: return replyClock(rest);
        case wire::HeadCommand::ProveOutput: return proveOutput(rest);
        case wire::HeadCommand::WantPreview: return sendPreview(rest);
        case wire::HeadCommand::Overlay: return !windows_ || windows_->overlay()->take(rest);
        case wire::HeadCommand::Finish:
            log::debug(log::Topic::Node, "the session ends");
            sendGoodbye();
            finished_ = true;
            return true;
        case wire::HeadCommand::Leave: return leave(rest);
        }
        return false;
    }

    void clientGone(uint32_t client) {
        calls_.erase(client);
        frames_.erase(client);
        if (player_) player_->clientGone(client);
        if (windows_) windows_->clientGone(client);
        if (sender_) sender_->clientGone(client);
        lostBits_.clientGone(client);
        reportWindowGone(client, wire::kAllWindows);
    }

    bool replyClock(std::span<const std::byte> arguments) {
        const auto reply = clockReplyTo(arguments);
        if (reply) line_->send(wire::NodeMessage::ClockReply, std::as_bytes(std::span(&*reply, 1)));
        return reply.has_value();
    }

    // The proof follows the pictures of earlier frames to the head.
    bool proveOutput(std::span<const std::byte> arguments) {
        const auto command = argument<wire::ProveOutputCommand>(arguments);
        if (!command || catchesUp_ || !player_) return command.has_value();
        const auto proof = outputProofOf(*command, completed_, windows_ ? windows_->shown().get() : nullptr);
        sendMessage(wire::NodeMessage::OutputProof, std::as_bytes(std::span(&proof, 1)));
        return true;
    }

    // The reply overtakes other messages of this node, because another thread sends it.
    bool sendPreview(std::span<const std::byte> arguments) {
        const auto command = argument<wire::WantPreviewCommand>(arguments);
        if (!command || catchesUp_ || !windows_) return command.has_value();
        if (!previews_)
            previews_ = std::make_unique<PreviewSender>(
                [this](std::span<const std::byte> header, std::span<const std::byte> jpeg) {
                    line_->send(wire::NodeMessage::PreviewTile, header, jpeg);
                });
        previews_->request(*command, windows_->shown());
        return true;
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
        line_->send(wire::NodeMessage::Alive, {}); // the versions are equal; GL may take a while
        auto platform = gl::openPlatform(setup_.glBackend, {setup_.gpu, setup_.gpuTurn, setup_.gpuTurns});
        if (!platform) return fail(platform.error().message);
        nlohmann::json ready = describeNode(**platform);
        const std::string renderer = ready.value("renderer", "");
        // Nodes on the same cores delay each other. PictureSender adds the CPU time of its thread to the frames.
        if (setup_.sharesMachine && gl::drawsWithoutGpu(renderer))
            work_.countCpu([this] { return sender_ ? sender_->cpuNs() : 0; });
        work_.begin();
        ready["placement"] = placeReplay(setup_, renderer);
        if (!setup_.stream.empty() && !setup_.isResyncing) {
            const auto followed = line_->follow(setup_.stream, setup_.streamSecret, name_);
            if (!followed) ready["ownStream"] = followed.error().message;
        }
        if (setup_.delta && !decodeBatches()) return false;
        if (setup_.pass.ranges > 1) {
            if (auto opened = openExchange(ready); !opened) return fail(opened.error().message);
        }
        if (setup_.swapMembers > 1) {
            if (auto opened = openBarrier(ready); !opened) return fail(opened.error().message);
        }
        if (setup_.wallWindows) {
            auto windows = TileWindows::open(setup_, windowInput());
            if (!windows) return fail(windows.error().message);
            windows_ = std::move(*windows);
        }
        if (setup_.sendPictures) openSender();
        PlayerConfig config = playerConfigOf(setup_, renderer);
        config.isOnHeadsMachine = line_->headHost().empty();
        losesPackets_ = config.plant == "rejoin";
        if (config.plant == "slow" && setup_.node == 1) work_.slowDown(kSlower);
        if (config.plant == "spans" && setup_.node == 0) spans_.delay();
        auto player = makePlayer_(std::move(*platform), config, createOutputs());
        if (!player) return fail(player.error().message);
        player_ = std::move(*player);
        lastCpuNs_ = threadCpuNs();
        spans_.record(setup_.recordsSpans);
        log::debug(log::Topic::Node, setup_.isResyncing ? "restarted, " : "", "draws with ",
                   renderer.empty() ? "no GL" : renderer);
        log::debug(log::Topic::Affinity, "thread of the replay: ", ready.value("placement", ""));
        line_->sendText(wire::NodeMessage::Ready, jsonText(ready));
        return true;
    }

    PlayerOutputs createOutputs() {
        PlayerOutputs outputs;
        outputs.answer = [this](const wire::ReplyPartHeader& h, std::span<const std::byte> bytes) {
            if (!catchesUp_ && !invalid_)
                sendMessage(wire::NodeMessage::ReplyPart, std::as_bytes(std::span(&h, 1)), bytes);
        };
        outputs.frameDone = [this](const PlayerOutputs::Frame& f) { frameDone(f); };
        outputs.invalid = [this] { invalid(); };
        outputs.windowGone = [this](uint32_t client, uint32_t window) { windowGone(client, window); };
        outputs.driverEvent = [this](const wire::DriverEvent& n, const std::string& text) {
            if (!catchesUp_)
                sendMessage(wire::NodeMessage::DriverEvent, std::as_bytes(std::span(&n, 1)),
                            std::as_bytes(std::span(text)));
        };
        outputs.readAhead = [this](Deadline deadline) { return readAhead(deadline); };
        outputs.objectRequest = [this](uint32_t client, std::span<const std::byte> message) {
            sendMessage(wire::NodeMessage::ObjectRequest, std::as_bytes(std::span(&client, 1)), message);
        };
        if (exchange_)
            outputs.composeParts = [this](PicturePart& part, const CompositeRule& rule, const std::vector<int>& order) {
                return exchange_->composer().compose(part, rule, order);
            };
        return outputs;
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
    bool decodeBatches() {
        const char* const plant = std::getenv("MURAL_PLANT");
        const auto started = line_->decodeBatches(static_cast<uint64_t>(setup_.cacheBytes), plant ? plant : "");
        return started || fail(started.error().message);
    }

    Result<void> openExchange(nlohmann::json& ready) {
        exchange_ = std::make_unique<ExchangePart>(setup_);
        auto port = exchange_->open();
        if (!port) return port.error();
        ready["exchange"] = endpointText(setup_.exchangeHere ? "127.0.0.1" : line_->ownAddress(), *port);
        return {};
    }

    bool connectNodes(const std::string& text) {
        const nlohmann::json json = parseJson(text);
        const auto addressOf = [&](const char* what, int n) { return addressIn(json, what, n, line_->headHost()); };
        if (exchange_) {
            const auto connected = exchange_->connect([&](int node) { return addressOf("pictures", node); });
            if (!connected) return fail(connected.error().message);
        }
        if (!swaps_ || setup_.swapRank == 0) return true;
        const auto leader = addressOf("swaps", setup_.swapLeader);
        if (!leader)
            return fail("the head sent no address of the swap barrier's leader; install the same version of mural on "
                        "all machines");
        swaps_->follow(leader->host, leader->port);
        return true;
    }

    // Sends the reason even if its level is off, because the head uses it.
    bool fail(const std::string& why) {
        line_->sendText(wire::NodeMessage::Log, why);
        if (line_->broken()) log::error(log::Topic::Node, why);
        return false;
    }

    bool synchronize(std::span<const std::byte> arguments) {
        const auto words = argument<std::array<uint32_t, 2>>(arguments);
        if (!words) return false;
        const auto [number, drawsAgain] = *words;
        if (drawsAgain != 0 && player_) player_->drawAgain();
        const wire::SynchronizedMessage done{
            number, static_cast<uint32_t>(player_ ? player_->validity() : wire::FrameValidity::Valid)};
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
        const auto words = argument<std::array<uint32_t, 4>>(arguments);
        if (!words) return false;
        const auto [view, node, isFirst, incarnation] = *words;
        const bool itself = node == static_cast<uint32_t>(setup_.node);
        if (isFirst != 0 && player_) {
            player_->beginTurns();
            player_->beginAreas();
        }
        shareWith(static_cast<int>(node), incarnation, arguments.subspan(sizeof *words));
        if (catchesUp_ && !itself) return true;
        if (std::exchange(catchesUp_, false)) work_.discard(); // the resync is no frame's work
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
        const auto rank = exchange_ && player_ ? exchange_->rankOf(node) : std::nullopt;
        if (!rank) return;
        std::set<int> absentRanks;
        for (const uint32_t other : argumentList<uint32_t>(absent))
            if (const auto absentRank = exchange_->rankOf(static_cast<int>(other))) absentRanks.insert(*absentRank);
        player_->resetShares(node == setup_.node, [this, rank = *rank, incarnation, absentRanks] {
            exchange_->composer().returned(rank, incarnation, absentRanks);
        });
    }

    bool sendPhaseState(std::span<const std::byte> number) {
        if (number.size() < sizeof(uint32_t)) return false;
        if (catchesUp_ || !player_) return true;
        if (!setup_.areas.empty()) {
            sendMessage(wire::NodeMessage::Turns, number.first(sizeof(uint32_t)), player_->memberAreas());
        } else if (setup_.pass.period > 1) {
            const std::vector<wire::WindowTurn> turns = player_->turns();
            sendMessage(wire::NodeMessage::Turns, number.first(sizeof(uint32_t)), std::as_bytes(std::span(turns)));
        }
        return true;
    }

    bool moveAreas(std::span<const std::byte> bytes) {
        auto areas = takeAreas(bytes);
        if (!areas || !bytes.empty()) return false;
        if (player_) player_->moveAreas(std::move(*areas));
        return true;
    }

    bool moveShares(std::span<const std::byte> bytes) {
        const auto shares = sharesOf(bytes);
        if (shares && player_) player_->moveShares(*shares);
        return shares.has_value();
    }

    bool takeTurns(std::span<const std::byte> bytes) {
        if (!setup_.areas.empty()) return !player_ || player_->takeMemberAreas(bytes);
        if (bytes.size() % sizeof(wire::WindowTurn) != 0) return false;
        if (player_) player_->takeTurns(argumentList<wire::WindowTurn>(bytes));
        return true;
    }

    bool joinGroup(std::span<const std::byte> arguments) {
        const auto node = argument<uint32_t>(arguments);
        if (!node) return false;
        if (*node == static_cast<uint32_t>(setup_.node)) line_->joinBeside(setup_.stream, setup_.streamSecret, name_);
        return true;
    }

    bool changeOver(std::span<const std::byte> arguments) {
        const auto command = argument<wire::SwitchToMulticastCommand>(arguments);
        if (!command) return false;
        if (command->node != static_cast<uint32_t>(setup_.node)) return true;
        const auto changed = line_->changeOver(uint64_t{command->skipHigh} << 32 | command->skipLow);
        return changed || fail("its stream cannot switch to multicast: " + changed.error().message);
    }

    void frameDone(const PlayerOutputs::Frame& f) {
        uint32_t& latest = frames_[f.client];
        latest = std::max(latest, f.frame);
        completed_ = {f.client, f.frame, monotonicNowNs()};
        if (!f.valid) invalid();
        if (catchesUp_ || invalid_) return;
        const uint64_t replayedNs = threadCpuNs();
        std::unique_ptr<PictureRead> picture;
        if (f.pixels && !f.region.empty()) {
            if (setup_.node == 0 && (sender_ || windows_)) lostBits_.report(f);
            if (sender_) picture = readPicture(f);
            work_.pause();
            if (windows_) showTiles(f);
            work_.begin(); // excludes a wait for the barrier or the display
        }
        work_.pause();
        wire::FrameDoneMessage done = frameDoneMessageOf(f);
        done.busyNs = static_cast<uint64_t>(work_.take());
        done.replayNs = replayedNs - lastCpuNs_;
        lastCpuNs_ = threadCpuNs();
        done.readbackNs = lastCpuNs_ - replayedNs;
        done.calls = calls_[f.client] + (f.client == clientInHand_ ? player_->counts().commands - callsBefore_ : 0);
        std::vector<wire::FrameSpan> spans = spans_.take();
        if (!picture) return sendDone(done, spans);
        const SpanScope waits(SpanKind::WaitQueue);
        stuck_ = !sender_->send({pictureHeaderOf(f), std::move(picture), done, std::move(spans)}) || stuck_;
        work_.begin(); // excludes a wait for queue space
    }

    // The spans precede the end of their frame.
    void sendDone(const wire::FrameDoneMessage& done, std::span<const wire::FrameSpan> spans) {
        const wire::FrameSpansHeader header = spansHeaderOf(done);
        const auto bytes = std::as_bytes(std::span(&header, 1));
        if (!spans.empty()) {
            if (windows_ && !sender_) windows_->overlay()->frameSpans(bytes, std::as_bytes(spans));
            sendMessage(wire::NodeMessage::FrameSpans, bytes, std::as_bytes(spans));
        }
        sendMessage(wire::NodeMessage::FrameDone, std::as_bytes(std::span(&done, 1)));
    }

    void windowGone(uint32_t client, uint32_t window) {
        if (windows_) windows_->windowGone(client, window);
        if (sender_) sender_->windowGone(client, window);
        lostBits_.windowGone(client, window);
        reportWindowGone(client, window);
    }

    void reportWindowGone(uint32_t client, uint32_t window) {
        if (catchesUp_) return;
        const wire::WindowGoneMessage gone{client, window};
        sendMessage(wire::NodeMessage::WindowGone, std::as_bytes(std::span(&gone, 1)));
    }

    void openSender() {
        PictureSenderConfig config;
        config.codec = setup_.pictureCodec;
        config.addsCpu = work_.countsCpu();
        config.transferScale = setup_.transferScale;
        config.alpha = setup_.windowPixels ? PictureAlpha::Preserved : PictureAlpha::Dropped;
        const auto send = [this, overlay = windows_ ? windows_->overlay() : nullptr](
                              wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
            if (overlay && type == wire::NodeMessage::FrameSpans && !b.empty()) overlay->frameSpans(a, b);
            line_->send(type, a, b);
        };
        sender_ = std::make_unique<PictureSender>(config, send);
        work_.begin(); // the sender's clock starts now
    }

    // Empty: the windows take no input.
    TileWindows::OnInput windowInput() {
        if (!setup_.windowInput) return {};
        return [this](const input::InputEvent& event) {
            line_->send(wire::NodeMessage::WindowInput, input::bytesOfEvent(event));
        };
    }

    void showTiles(const PlayerOutputs::Frame& f) {
        const auto shown = windows_->show(f, swaps_ ? swaps_->barrier() : nullptr);
        if (!shown) {
            log::warning(log::Topic::Output, "the wall windows are lost: ", shown.error().message);
            windows_.reset();
        }
    }

    bool leave(std::span<const std::byte> arguments) {
        const auto node = argument<uint32_t>(arguments);
        if (!node || *node != static_cast<uint32_t>(setup_.node)) return node.has_value();
        log::debug(log::Topic::Node, "leaves the session after its last frame");
        sendGoodbye();
        finished_ = true;
        return true;
    }

    void sendGoodbye() {
        if (sender_ && !sender_->finish()) return; // the sender has logged the reason
        const GoodbyeParts parts{player_.get(), exchange_.get(),    sender_.get(),
                                 swaps_.get(),  setup_.swapMembers, line_->receivedBytes()};
        line_->sendText(wire::NodeMessage::Goodbye, jsonText(goodbyeOf(parts)));
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
    const MakePlayer makePlayer_;
    std::unique_ptr<StreamPlayer> player_;  // null before the setup
    std::unique_ptr<PictureSender> sender_; // null: the head requests no pictures
    bool stuck_ = false;                    // the sender failed: no message leaves this node
    ReplaySpans spans_;                     // while statistics are on
    uint64_t lastCpuNs_ = 0;
    WorkClock work_;
    std::map<uint32_t, uint64_t> calls_;  // commands by client, in completed packets
    std::map<uint32_t, uint32_t> frames_; // latest frame by client
    CompletedFrame completed_;
    std::unique_ptr<PreviewSender> previews_; // null: nobody has looked
    LostBitsNotice lostBits_;
    bool invalid_ = false;      // this node can't draw the picture of the others
    bool losesPackets_ = false; // planted fault
    int packetsGiven_ = 0;      // packets received during the resync
    bool catchesUp_ = false;    // in resync: replays commands whose messages the head has from other nodes
    uint32_t clientInHand_ = 0; // client of the current or latest packet
    uint64_t callsBefore_ = 0;  // commands of all clients before that packet
    bool finished_ = false;
    std::deque<AheadPacket> ahead_;          // to be taken before further packets of line_
    std::unique_ptr<ExchangePart> exchange_; // null: this node draws all ranges of its picture
};

} // namespace

int runNode(const NodeOptions& options, const MakePlayer& makePlayer) {
    signal(SIGPIPE, SIG_IGN); // the end of a display is an error of its windows and must not end the node
    const PauseWatch pauseWatch;
    auto line = HeadConnection::open(options);
    if (!line) {
        log::error(log::Topic::Node, line.error().message);
        return 1;
    }
    return Node(std::move(*line), options.name, makePlayer).run();
}

} // namespace mural
