#include "nodes/head/capture/program_table.hpp"

#include <algorithm>
#include <poll.h>

#include "common/base/copy_bytes.hpp"
#include "common/log/log.hpp"
#include "nodes/head/frames/picture_replies.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {
namespace {

constexpr int64_t kEndPatienceMs = 5000;
constexpr uint32_t kMaxIds = 65535; // streams carry 16 bits of it, see wire::streamOf

} // namespace

ProgramTable::ProgramTable(ProgramTerms terms, StreamBroadcaster& nodes, Events events)
    : terms_(std::move(terms)), nodes_(nodes), events_(std::move(events)), latency_(terms_.latency) {}

ProgramTable::~ProgramTable() { endAll(); }

Result<Admission> ProgramTable::admitProgram(pid_t pid, capture::ProgramKind kind) {
    if (kind != terms_.kind)
        return Error{kind == capture::ProgramKind::Native
                         ? "this program uses the native API, but the render nodes draw captured programs; start it "
                           "with mural run --node-program PROGRAM"
                         : "the render nodes of this session draw a program with the native API only; start this "
                           "program in a session of its own"};
    // A script starts its next program as soon as one has ended. The wall would show the window of the ended one until
    // its pump notices, and drop the first frames of the next program.
    for (const auto& client : all()) client->detectEnd();
    auto memory = CaptureMemory::create(terms_.chunkCount);
    const std::lock_guard lock(mutex_);
    if (!refusal_.empty()) return Error{refusal_};
    if (!memory) return memory.error();
    if (nextId_ > kMaxIds) return Error{"this session has started 65535 programs, the maximum; start a new session"};
    const uint32_t id = nextId_++;
    Admission admission;
    admission.welcome = terms_.welcome;
    admission.welcome.clientId = id;
    admission.welcome.members = static_cast<uint32_t>(members_.size());
    (*memory)->setLatency(latency_);
    admission.memoryFd = (*memory)->fdToPass();
    admission.extensions = terms_.extensions;
    admitted_[id] = std::make_shared<CaptureClient>(id, pid, kind, std::move(*memory), nodes_, *this, terms_.statistics,
                                                    terms_.sentFrames);
    return admission;
}

void ProgramTable::programWelcomed(uint32_t id, FileDescriptor socket) {
    size_t count = 0;
    Result<void> started;
    {
        const std::lock_guard lock(mutex_);
        const auto found = admitted_.find(id);
        if (found == admitted_.end()) return;
        const auto client = found->second;
        admitted_.erase(found);
        if (!socket.valid()) return;                   // the program left before it was admitted
        if (headGone_) client->memory().setHeadGone(); // the nodes were lost before its admission
        log::debug(log::Topic::Program, client->describe(), " has connected");
        events_.came(*client);
        if (terms_.kind == capture::ProgramKind::Native)
            for (const auto& [node, name] : members_) client->reply(memberReply(node, name));
        started = client->start(std::move(socket));
        clients_[id] = client;
        count = clients_.size();
    }
    events_.countChanged(count);
    if (!started) programEnded(id, started.error().message);
}

void ProgramTable::programEnded(uint32_t id, const std::string& problem) {
    std::string line;
    size_t count = 0;
    {
        const std::lock_guard lock(mutex_);
        const auto found = clients_.find(id);
        if (found == clients_.end()) return;
        log::debug(log::Topic::Program, found->second->describe(), " is gone, ", found->second->bytesSent(), " bytes");
        if (!problem.empty())
            line = found->second->describe() + " was disconnected: " + problem + "; it continues alone";
        addCounts(goneCounts_, found->second->memory().counts());
        if (auto names = found->second->memory().displayNames(); !names.empty()) goneDisplays_[id] = std::move(names);
        gone_.push_back(found->second);
        clients_.erase(found);
        progress_.erase(id);
        count = clients_.size();
    }
    const uint32_t argument = id;
    nodes_.broadcast(wire::HeadCommand::ClientGone, std::as_bytes(std::span(&argument, 1)));
    events_.gone(id);
    if (!line.empty()) log::warning(log::Topic::Program, line);
    events_.countChanged(count);
}

void ProgramTable::refuseFrom(const std::string& reason) {
    const std::lock_guard lock(mutex_);
    refusal_ = reason;
}

void ProgramTable::reply(uint32_t id, Reply reply) {
    if (const auto client = find(id)) client->reply(std::move(reply));
}

// No name: the node is no longer a member.
Reply ProgramTable::memberReply(int node, const std::string& name) {
    Reply reply;
    reply.header.requestId = static_cast<uint32_t>(node);
    reply.header.kind = static_cast<uint32_t>(wire::ReplyKind::Member);
    reply.bytes = ByteBuffer::ofSize(name.size());
    copyBytes(std::as_bytes(std::span(name)), reply.bytes.span());
    reply.header.sizeBytes = reply.bytes.size();
    return reply;
}

void ProgramTable::reportMember(int node, const std::string& name) {
    if (terms_.kind != capture::ProgramKind::Native) return;
    for (const auto& [id, client] : clients_) client->reply(memberReply(node, name));
}

void ProgramTable::memberCame(int node, const std::string& name) {
    const std::lock_guard lock(mutex_);
    members_[node] = name;
    reportMember(node, name);
}

void ProgramTable::memberLost(int node) {
    const std::lock_guard lock(mutex_);
    if (members_.erase(node) > 0) reportMember(node, "");
}

void ProgramTable::driverEvent(const wire::DriverEvent& event, const std::string& text) {
    // the event is dropped if the program reads none
    if (const auto client = find(event.client)) (void)client->memory().putDriverEvent(event, text);
}

void ProgramTable::setLatency(uint32_t frames) {
    const std::lock_guard lock(mutex_);
    latency_ = frames;
    for (const auto& [id, client] : admitted_) client->memory().setLatency(frames);
    for (const auto& [id, client] : clients_) {
        client->memory().setLatency(frames);
        publishProgress(*client, progress_[id]); // without latency, the credit waits for the windows
    }
}

uint32_t ProgramTable::latency() const {
    const std::lock_guard lock(mutex_);
    return latency_;
}

void ProgramTable::credit(uint32_t id, uint32_t finished, uint32_t shown) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end()) return;
    Progress& progress = progress_[id];
    progress.finished = finished;
    progress.shown = shown;
    publishProgress(*found->second, progress);
}

void ProgramTable::displayBlocked(uint32_t id, bool isBlocked) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end()) return;
    Progress& progress = progress_[id];
    progress.isBlocked = isBlocked;
    publishProgress(*found->second, progress);
}

// A program receives no further credit while too many of its pictures wait for their window; without latency, while
// any of them waits. Requires mutex_.
void ProgramTable::publishProgress(CaptureClient& client, const Progress& progress) const {
    constexpr uint32_t kMaxUnshown = 3;
    const uint32_t allowed = progress.shown + (latency_ == 0 ? 0 : kMaxUnshown);
    const bool isLimited = terms_.welcome.displayApp != 0 && !progress.isBlocked;
    client.memory().setFramesDone(isLimited ? std::min(progress.finished, allowed) : progress.finished);
    client.memory().setFramesShown(progress.shown);
}

bool ProgramTable::giveOwnPicture(uint32_t id, uint32_t frame, uint64_t nativeWindow, const Picture& picture,
                                  std::function<void()> done) {
    const auto client = find(id);
    const auto format = client ? client->memory().ownWindow(static_cast<uint32_t>(nativeWindow), frame) : std::nullopt;
    if (!format) return false;
    Reply reply = ownPictureReply(frame, static_cast<uint32_t>(nativeWindow), *format, picture);
    reply.written = std::move(done);
    client->reply(std::move(reply));
    return true;
}

bool ProgramTable::beginOverlay(uint32_t id) {
    const auto client = find(id);
    return !client || client->memory().beginOverlay();
}

void ProgramTable::endOverlay(uint32_t id) {
    if (const auto client = find(id)) client->memory().endOverlay();
}

void ProgramTable::beat() {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, client] : clients_) client->memory().beat();
}

void ProgramTable::reportHeadGone() {
    {
        const std::lock_guard lock(mutex_);
        headGone_ = true;
    }
    for (const auto& client : all()) client->memory().setHeadGone();
}

void ProgramTable::drainAll(Deadline deadline, const std::function<void()>& tick) {
    constexpr int kSliceMs = 10;
    // Programs in the process of admission may have published already.
    while (anyAdmitted() && !deadline.passed()) {
        tick();
        poll(nullptr, 0, kSliceMs);
    }
    const auto clients = all();
    for (const auto& client : clients) client->drain();
    const auto ended = [](const auto& client) { return client->pumpEnded(); };
    while (!std::ranges::all_of(clients, ended) && !deadline.passed()) {
        tick();
        poll(nullptr, 0, kSliceMs);
    }
    for (const auto& client : clients)
        if (!client->pumpEnded()) client->stop();
}

void ProgramTable::reap() {
    std::vector<std::shared_ptr<CaptureClient>> ended;
    {
        const std::lock_guard lock(mutex_);
        const auto isOver = [](const auto& client) { return client->pumpEnded(); };
        const auto firstOver = std::partition(gone_.begin(), gone_.end(), std::not_fn(isOver));
        ended.assign(std::make_move_iterator(firstOver), std::make_move_iterator(gone_.end()));
        gone_.erase(firstOver, gone_.end());
    }
    // Joined here, outside of the lock.
}

void ProgramTable::endAll() {
    constexpr int kSliceMs = 5;
    const auto clients = all();
    for (const auto& client : clients) {
        client->memory().setHeadGone();
        client->stop();
    }
    const auto ended = [](const auto& client) { return client->pumpEnded(); };
    const Deadline deadline = Deadline::inMs(kEndPatienceMs);
    while (!std::ranges::all_of(clients, ended) && !deadline.passed()) poll(nullptr, 0, kSliceMs);

    Clients last;
    Clients unwelcomed;
    std::vector<std::shared_ptr<CaptureClient>> gone;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [id, client] : clients_) addCounts(goneCounts_, client->memory().counts());
        last.swap(clients_);
        unwelcomed.swap(admitted_);
        gone.swap(gone_);
    }
    // Joined here, outside of the lock.
}

std::string ProgramTable::displayName(uint32_t client, uint32_t number) const {
    const std::lock_guard lock(mutex_);
    const auto here = clients_.find(client);
    const auto gone = goneDisplays_.find(client);
    const std::vector<std::string> names = here != clients_.end()        ? here->second->memory().displayNames()
                                           : gone != goneDisplays_.end() ? gone->second
                                                                         : std::vector<std::string>();
    return number < names.size() ? names[number] : std::string();
}

CaptureCounts ProgramTable::counts() const {
    const std::lock_guard lock(mutex_);
    CaptureCounts sum = goneCounts_;
    for (const auto& [id, client] : clients_) addCounts(sum, client->memory().counts());
    return sum;
}

std::vector<ProgramStatus> ProgramTable::status() const {
    std::vector<ProgramStatus> result;
    for (const auto& client : all()) {
        ProgramStatus program;
        program.id = client->id();
        program.pid = client->pid();
        program.command = commandLineOf(client->pid());
        if (program.command.empty()) program.command = client->name();
        program.bytesSent = client->bytesSent();
        program.counts = client->memory().counts();
        result.push_back(std::move(program));
    }
    return result;
}

std::shared_ptr<CaptureClient> ProgramTable::find(uint32_t id) const {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    return found == clients_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<CaptureClient>> ProgramTable::all() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<CaptureClient>> result;
    for (const auto& [id, client] : clients_) result.push_back(client);
    return result;
}

bool ProgramTable::anyAdmitted() const {
    const std::lock_guard lock(mutex_);
    return !admitted_.empty();
}

void ProgramTable::addCounts(CaptureCounts& sum, const CaptureCounts& counts) {
    sum.verifiedFrames += counts.verifiedFrames;
    sum.verifiedPixels += counts.verifiedPixels;
    sum.differingPixels += counts.differingPixels;
    sum.squaredDifference += counts.squaredDifference;
    sum.largestDifference = std::max(sum.largestDifference, counts.largestDifference);
    for (size_t i = 0; i < counts.uncomparedFrames.size(); ++i) sum.uncomparedFrames[i] += counts.uncomparedFrames[i];
    sum.callsUnsupported += counts.callsUnsupported;
    for (const auto& [command, calls] : counts.unsupportedBy) sum.unsupportedBy[command] += calls;
    sum.roundTrips += counts.roundTrips;
    for (size_t i = 0; i < counts.waitNs.size(); ++i) sum.waitNs[i] += counts.waitNs[i];
    for (const auto& [command, trips] : counts.tripsBy) sum.tripsBy[command] += trips;
    sum.frameCpuNs += counts.frameCpuNs;
    sum.frameCpuFrames += counts.frameCpuFrames;
}

} // namespace mural
