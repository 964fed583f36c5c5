#include "native/runtime/native_player.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

#include "common/log/log.hpp"
#include "native/runtime/current_gl.hpp"
#include "nodes/frame_transfer/scale_picture.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural::native {

namespace {

constexpr size_t kMaxReports = 100; // different texts

compositor::DepthFunction functionOf(Composition::DepthTest test) {
    switch (test) {
    case Composition::DepthTest::LessOrEqual: return compositor::DepthFunction::LessOrEqual;
    case Composition::DepthTest::Greater: return compositor::DepthFunction::Greater;
    case Composition::DepthTest::GreaterOrEqual: return compositor::DepthFunction::GreaterOrEqual;
    case Composition::DepthTest::Less: break;
    }
    return compositor::DepthFunction::Less;
}

// Runs a function of the program. An exception becomes an error.
template <class Function> Result<void> guarded(const char* name, Function&& function) {
    try {
        return function();
    } catch (const std::exception& e) {
        return Error{std::string(name) + " has thrown: " + e.what()};
    } catch (...) {
        return Error{std::string(name) + " has thrown an unknown exception"};
    }
}

Matrix4 headOf(const wire::NativeFrame& frame) {
    Matrix4 head;
    for (size_t i = 0; i < 12; ++i) head.m[i / 4][i % 4] = frame.head[i];
    return head;
}

bool isEqualPart(const FramePart& a, const FramePart& b) {
    const RenderContext &x = a.context, &y = b.context;
    return a.drawn == b.drawn && a.surface == b.surface && a.picture == b.picture && x.range == y.range &&
           a.pass.zoom == b.pass.zoom;
}

} // namespace

Result<std::unique_ptr<StreamPlayer>> NativePlayer::open(std::unique_ptr<gl::Platform> platform,
                                                         const PlayerConfig& config, PlayerOutputs outputs,
                                                         std::unique_ptr<Renderer> renderer) {
    std::unique_ptr<NativePlayer> player(new NativePlayer(config, std::move(outputs), std::move(renderer)));
    player->skips_ = config.skips;
    player->isComposing_ = !config.isResyncing;
    player->areas_ = config.areas;
    GlWish wish;
    if (auto asked = guarded("Renderer::wish",
                             [&] {
                                 wish = player->renderer_->wish();
                                 return Result<void>();
                             });
        !asked)
        return asked.error();
    auto target = GlTarget::open(std::move(platform), wish);
    if (!target) return target.error();
    player->target_ = std::move(*target);
    setCurrentTarget(player->target_.get());
    const auto text = [&](GLenum name) {
        const auto* bytes = player->target_->gl().getString(name);
        return bytes ? std::string(reinterpret_cast<const char*>(bytes)) : std::string();
    };
    player->pipe_ = {config.node, text(GL_RENDERER), text(GL_VERSION)};
    auto started = guarded("Renderer::start", [&] { return player->renderer_->start(player->pipe_); });
    if (!started) return started.error();
    player->hasStarted_ = true;
    return std::unique_ptr<StreamPlayer>(std::move(player));
}

NativePlayer::~NativePlayer() {
    if (hasStarted_) runTask("Renderer::end", [this] { renderer_->end(pipe_); });
    renderer_.reset();
    setCurrentTarget(nullptr);
}

// ---- the stream

// Applies the objects of a packet that is played later. The versions of a frame are known before it is drawn, and later
// frames do not change them.
void NativePlayer::preview(uint32_t stream, std::span<const std::byte> payload) {
    ++previewed_;
    wire::RecordWalk walk(payload);
    wire::RecordView r;
    while (walk.next(r)) takeObjects(stream, r.opcode, r.arguments);
}

bool NativePlayer::packet(uint32_t stream, std::span<const std::byte> payload) {
    const bool isPreviewed = previewed_ > 0;
    if (isPreviewed) --previewed_;
    counts_.bytes += payload.size();
    const std::vector<std::byte> own(payload.begin(), payload.end()); // readAhead() invalidates the payload
    wire::RecordWalk walk(own);
    wire::RecordView r;
    while (walk.next(r)) {
        if (!isPreviewed) takeObjects(stream, r.opcode, r.arguments);
        if (wire::threadOf(stream) != wire::kToAllNodes) continue; // objects only; not counted, as nodes differ in them
        ++counts_.commands;
        if (!record(clientOf(wire::clientOf(stream)), wire::clientOf(stream), r.opcode, r.arguments)) {
            ++counts_.malformed;
            return false;
        }
    }
    return walk.whole();
}

NativePlayer::Client& NativePlayer::clientOf(uint32_t id) {
    const auto found = clients_.find(id);
    if (found != clients_.end()) return *found->second;
    auto send = [this, id](std::span<const std::byte> message) {
        if (out_.objectRequest) out_.objectRequest(id, message);
    };
    ClientObjects::Await await;
    if (out_.readAhead)
        await = [this](Deadline deadline) {
            isEnding_ = isEnding_ || out_.readAhead(deadline) == ReadAhead::Ended;
            return !isEnding_;
        };
    const bool mapsBlobs = config_.isOnHeadsMachine && config_.plant != "places";
    auto made = std::make_unique<Client>(std::move(send), await, mapsBlobs);
    return *clients_.emplace(id, std::move(made)).first->second;
}

void NativePlayer::takeObjects(uint32_t stream, uint16_t opcode, std::span<const std::byte> arguments) {
    Client& client = clientOf(wire::clientOf(stream));
    if (opcode == wire::kOpObject) {
        if (const auto taken = client.objects.input(wire::threadOf(stream), arguments); !taken)
            reportOnce(taken.error().message);
    } else if (opcode == wire::kOpFrame && arguments.size() >= sizeof(wire::NativeFrame)) {
        wire::NativeFrame frame{};
        std::memcpy(&frame, arguments.data(), sizeof frame);
        client.objects.frame(frame.number);
    }
}

bool NativePlayer::record(Client& client, uint32_t clientId, uint16_t opcode, std::span<const std::byte> arguments) {
    switch (opcode) {
    case wire::kOpObject: return true; // takeObjects() has it
    case wire::kOpFrame:
        if (arguments.size() < sizeof client.frame) return false;
        std::memcpy(&client.frame, arguments.data(), sizeof client.frame);
        return true;
    case wire::kOpWindow: {
        uint32_t id = 0;
        wire::WindowConfig config{};
        if (arguments.size() < sizeof id + sizeof config) return false;
        std::memcpy(&id, arguments.data(), sizeof id);
        std::memcpy(&config, arguments.data() + sizeof id, sizeof config);
        constexpr uint32_t kMaxSize = 1 << 20;
        if (config.width == 0 || config.height == 0 || config.width > kMaxSize || config.height > kMaxSize)
            return false;
        client.windows[id] = config;
        return true;
    }
    case wire::kOpSwap: {
        uint32_t words[2] = {};
        if (arguments.size() < sizeof words) return false;
        std::memcpy(words, arguments.data(), sizeof words);
        if (words[1] != wire::kUnseenFrame) onSwap(clientId, client, words[0], words[1]);
        return true;
    }
    default: return false;
    }
}

void NativePlayer::clientGone(uint32_t client) {
    clients_.erase(client);
    lastPart_.reset();
    isEnding_ = false; // another program may follow
}

void NativePlayer::onSwap(uint32_t clientId, Client& client, uint32_t window, uint32_t frame) {
    const auto found = client.windows.find(window);
    if (found == client.windows.end()) return;
    ++counts_.frames;
    const wire::WindowConfig& config = found->second;
    const FramePart part = framePartOf(config_, areas_ ? &*areas_ : nullptr, share_, static_cast<int32_t>(config.width),
                                       static_cast<int32_t>(config.height), frame, target_->samples());
    composed_.reset();
    if (!skips_ && !part.drawn.empty()) drawFrame(client, clientId, part, config, frame);

    PlayerOutputs::Frame f{};
    f.client = clientId;
    f.window = window;
    f.frame = frame;
    f.config = config;
    f.region = part.shown;
    f.format = PictureFormat::Bgra8;
    f.picture = part.picture;
    f.valid = true;
    f.areas = part.areas;
    f.shares = takesRanges() ? sharesNumber_ : 0;
    f.pixels = [&](const PixelViewport& box) { return pixelsOf(part, box); };
    f.read = [&]() -> std::unique_ptr<PictureRead> {
        const std::byte* const bytes = pixelsOf(part, part.shown);
        return std::make_unique<ReadPicture>(
            std::vector<std::byte>(bytes, bytes + static_cast<size_t>(part.shown.area()) * 4), nullptr);
    };
    out_.frameDone(f);
    client.objects.frameDone(client.frame.number);
}

// ---- drawing

void NativePlayer::drawFrame(Client& client, uint32_t clientId, const FramePart& part, const wire::WindowConfig& window,
                             uint32_t frame) {
    if (auto sized = target_->resize(part.surface); !sized) return reportOnce(sized.error().message);
    ViewInput view;
    view.width = static_cast<int32_t>(window.width);
    view.height = static_cast<int32_t>(window.height);
    view.pass = part.pass;
    view.screen = config_.screen;
    view.eyeBase = config_.eyeBase;
    view.wallDistance = config_.focusDistance;
    view.head = headOf(client.frame);
    client.objects.beginDrawing(client.frame.number);
    const Frame info{client.frame.number, client.frame.seconds, client.frame.seed};
    const bool isSame = lastPart_ && isEqualPart(*lastPart_, part);
    Composition composition;
    runTask("Renderer::composition", [&] { composition = renderer_->composition(); });
    TaskState state(part, view, info, isSame, composition, *target_, client.objects,
                    [this](const std::string& text) { reportOnce(text); });
    RenderTask task(state);
    runTask("Renderer::frameStart", [&] { renderer_->frameStart(pipe_, info); });
    runTask("Renderer::clear", [&] { renderer_->clear(task); });
    PicturePart cleared;
    if (takesRanges()) {
        cleared.colour.resize(1);
        cleared.depth.resize(1);
        const PixelViewport corner{part.drawn.x, part.drawn.y, 1, 1};
        target_->readColour(corner, GL_RGBA, cleared.colour.data());
        target_->readDepth(corner, cleared.depth.data());
    }
    if (!takesRanges() || !part.context.range.empty()) runTask("Renderer::draw", [&] { renderer_->draw(task); });
    if (takesRanges()) compose(clientId, part, frame, std::move(cleared), state);
    if (!part.shown.empty()) {
        if (composed_)
            state.beforeApply = [this] {
                target_->writeColour(composed_->id.box, composed_->colour.data());
                composed_.reset();
            };
        runTask("Renderer::overlay", [&] { renderer_->overlay(task); });
    }
    if (part.shown.empty()) target_->gl().finish(); // otherwise the read of the picture waits
    runTask("Renderer::frameEnd", [&] { renderer_->frameEnd(pipe_, info); });
    lastPart_ = part;
}

// Composes the picture with the other nodes' ranges. `cleared`: one pixel with the values of the clears.
void NativePlayer::compose(uint32_t clientId, const FramePart& part, uint32_t frame, PicturePart cleared,
                           TaskState& task) {
    if (!isComposing_ || !out_.composeParts) return;
    for (; !returns_.empty(); returns_.pop_front()) returns_.front()();
    CompositeRule rule;
    rule.blends = task.composition.by == Composition::By::Over;
    rule.function = functionOf(task.composition.depthTest);
    rule.clearedColour = cleared.colour[0];
    rule.clearedDepth = cleared.depth[0];
    rule.deep = target_->depthBits() > 24;
    PicturePart own;
    own.id = {clientId, frame, part.drawn};
    const auto pixels = static_cast<size_t>(part.drawn.area());
    rule.hasHalfFloats = rule.blends && target_->isHalfFloat();
    own.colour.resize(pixels * rule.colourWords());
    if (rule.hasHalfFloats)
        target_->readHalfFloats(part.drawn, own.colour.data());
    else
        target_->readColour(part.drawn, GL_RGBA, own.colour.data());
    if (!rule.blends) {
        own.depth.resize(pixels);
        target_->readDepth(part.drawn, own.depth.data());
    }
    (void)out_.composeParts(own, rule, rule.blends ? blendOrder(task) : std::vector<int>());
    if (part.shown.empty()) return;
    if (rule.hasHalfFloats)
        target_->writeHalfFloats(part.drawn, own.colour.data());
    else
        composed_ = std::move(own);
}

// The ranks from back to front. Every node evaluates the same function, so all nodes agree.
std::vector<int> NativePlayer::blendOrder(TaskState& state) {
    RenderTask task(state);
    std::vector<double> distances(ranges_.size());
    bool isComplete = false;
    runTask("Renderer::order", [&] {
        for (size_t i = 0; i < ranges_.size(); ++i) distances[i] = renderer_->order(task, ranges_[i]);
        if (!std::ranges::all_of(distances, [](double d) { return std::isfinite(d); }))
            throw std::range_error("a position that is not finite");
        isComplete = true;
    });
    if (!isComplete) std::ranges::fill(distances, 0); // the ranges then decide, on all nodes alike
    std::vector<int> order(ranges_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    const auto isBehind = [&](int a, int b) {
        const auto x = static_cast<size_t>(a), y = static_cast<size_t>(b);
        return distances[x] != distances[y] ? distances[x] > distances[y] : ranges_[x].start > ranges_[y].start;
    };
    std::ranges::stable_sort(order, isBehind);
    return order;
}

// The pixels of `box` in the output picture, B G R A, rows bottom first.
const std::byte* NativePlayer::pixelsOf(const FramePart& part, const PixelViewport& box) {
    const size_t bytes = static_cast<size_t>(std::max<int64_t>(box.area(), 0)) * 4;
    pixels_.assign(bytes, std::byte{0});
    if (bytes == 0 || skips_ || part.drawn.empty()) return pixels_.data();
    const bool isZoomed = part.pass.zoom != part.pass.shown;
    const PixelViewport source = isZoomed ? part.drawn : intersect(box, part.drawn);
    if (source.empty()) return pixels_.data();
    std::vector<std::byte> drawn(static_cast<size_t>(source.area()) * 4);
    if (composed_) {
        for (int32_t y = 0; y < source.h; ++y)
            for (int32_t x = 0; x < source.w; ++x) {
                const PixelViewport& own = composed_->id.box;
                const uint32_t rgba = composed_->colour[composed_->at(source.x - own.x + x, source.y - own.y + y)];
                const uint32_t bgra = (rgba & 0xff00ff00U) | (rgba & 0xffU) << 16 | (rgba >> 16 & 0xffU);
                std::memcpy(
                    &drawn[(static_cast<size_t>(y) * static_cast<size_t>(source.w) + static_cast<size_t>(x)) * 4],
                    &bgra, 4);
            }
    } else {
        target_->readColour(source, GL_BGRA, drawn.data());
    }
    if (isZoomed) {
        const Zoom by{part.pass.zoom.x / part.pass.shown.x, part.pass.zoom.y / part.pass.shown.y};
        scalePicture({drawn.data(), source}, by, intersect(box, part.shown), pixels_.data(), box);
    } else if (source == box) {
        pixels_ = std::move(drawn);
    } else {
        for (int32_t y = 0; y < source.h; ++y)
            std::memcpy(&pixels_[(static_cast<size_t>(source.y - box.y + y) * static_cast<size_t>(box.w) +
                                  static_cast<size_t>(source.x - box.x)) *
                                 4],
                        &drawn[static_cast<size_t>(y) * static_cast<size_t>(source.w) * 4],
                        static_cast<size_t>(source.w) * 4);
    }
    return pixels_.data();
}

void NativePlayer::runTask(const char* name, const std::function<void()>& task) {
    const auto done = guarded(name, [&] {
        task();
        return Result<void>();
    });
    if (!done) reportOnce(done.error().message);
    const GLenum error = target_ ? target_->gl().getError() : GLenum{GL_NO_ERROR};
    if (error == GL_NO_ERROR) return;
    ++counts_.glErrors;
    char code[16];
    std::snprintf(code, sizeof code, "0x%04x", error);
    reportOnce(std::string(name) + " leaves the GL error " + code);
    for (int i = 0; i < 16 && target_->gl().getError() != GL_NO_ERROR; ++i) ++counts_.glErrors;
}

void NativePlayer::reportOnce(const std::string& text) {
    if (isEnding_) return log::debug(log::Topic::Replay, text); // objects are missing because the session ends
    if (reported_.size() < kMaxReports && reported_.insert(text).second) log::warning(log::Topic::Replay, text);
}

// ---- changes of the division of work. Each takes effect with the next frame, on all nodes alike.

void NativePlayer::resetShares(bool itself, std::function<void()> returned) {
    if (!takesRanges()) return;
    share_ = config_.pass.share; // new shares follow
    ranges_ = config_.ranges;
    sharesNumber_ = 0;
    isComposing_ = isComposing_ || itself;
    returns_.push_back(std::move(returned));
}

void NativePlayer::moveShares(const RangeAssignment& shares) {
    const auto node = static_cast<size_t>(config_.node);
    if (!takesRanges() || node >= shares.ofNodes.size()) return;
    share_ = shares.ofNodes[node];
    const size_t collector = node - static_cast<size_t>(config_.pass.range);
    for (size_t i = 0; i < ranges_.size() && collector + i < shares.ofNodes.size(); ++i)
        ranges_[i] = shares.ofNodes[collector + i];
    sharesNumber_ = shares.number;
}

void NativePlayer::moveAreas(ViewportAssignment areas) {
    if (areas_) areas_ = std::move(areas);
}

// The payload of Replay::memberAreas(), without windows.
std::vector<std::byte> NativePlayer::memberAreas() const {
    std::vector<std::byte> bytes(sizeof(uint32_t));
    if (!areas_) return bytes;
    const auto areas = bytesOf(*areas_);
    bytes.insert(bytes.end(), areas.begin(), areas.end());
    return bytes;
}

bool NativePlayer::takeMemberAreas(std::span<const std::byte> bytes) {
    uint32_t windows = 0;
    if (!areas_ || bytes.size() < sizeof windows) return false;
    std::memcpy(&windows, bytes.data(), sizeof windows);
    bytes = bytes.subspan(sizeof windows);
    auto areas = windows == 0 ? takeAreas(bytes) : std::nullopt;
    if (!areas) return false;
    areas_ = std::move(*areas);
    return true;
}

} // namespace mural::native
