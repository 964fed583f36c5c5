#include "recording/trim/trim_plan.hpp"

#include <algorithm>

#include "recording/record_values.hpp"
#include "recording/trim/record_roles.hpp"

namespace mural::recording {

bool TrimPlanner::entry(const Entry& entry) {
    if (before_ && frames_.frames() + 1 >= first_) {
        before_ = false;
        plan_.beganNs = entry.timeNs;
    }
    if (entry.stream != 0) return packet(entry);
    ClientEvent event;
    if (!parseEvent(entry.payload, event) || event.kind != Event::ClientGone) return true;
    frames_.clientGone(event.client);
    if (before_) {
        plan_.goneClients.insert(event.client);
        clients_.erase(event.client);
        std::erase_if(threads_, [&](const auto& t) { return wire::clientOf(t.first) == event.client; });
    }
    return true;
}

bool TrimPlanner::packet(const Entry& entry) {
    Client& client = clients_[wire::clientOf(entry.stream)];
    Thread& thread = threads_[entry.stream];
    RecordWalk walk(entry.payload);
    RecordView r;
    for (; walk.next(r); ++number_) {
        record(client, thread, r);
        const int64_t ended = frames_.record(entry.stream, r);
        if (ended == 0) continue;
        if (ended + 1 == first_ && before_) {
            before_ = false;
            plan_.beganNs = entry.timeNs;
        }
        if (ended == first_) {
            plan_.shownFrom = number_;
            settled_ = true;
        }
        if (ended < last_) continue;
        plan_.endRecord = number_;
        return false;
    }
    plan_.endRecord = number_;
    if (walk.malformed()) client.doubts.doubt("its stream is malformed");
    return true;
}

// The record's own number, behind those of the blobs that it takes.
RecordNumbers TrimPlanner::withBlobs(Thread& thread, const RecordView& r) {
    RecordNumbers numbers;
    for (size_t n = blobsTakenBy(r); n > 0 && !thread.blobs.empty(); --n) {
        numbers.insert(numbers.end(), thread.blobs.front().begin(), thread.blobs.front().end());
        thread.blobs.erase(thread.blobs.begin());
    }
    numbers.push_back(number_);
    return numbers;
}

void TrimPlanner::record(Client& client, Thread& thread, const RecordView& r) {
    if (r.opcode == wire::kOpBlobBegin) thread.blobs.emplace_back();
    if (r.opcode == wire::kOpBlobBegin || r.opcode == wire::kOpBlobData) {
        if (!thread.blobs.empty()) thread.blobs.back().push_back(number_);
        return;
    }
    ContextState& context = client.contexts[thread.context];
    context.record(r, client.doubts);
    RecordNumbers numbers = withBlobs(thread, r);
    if (r.opcode == wire::kOpClientArrays) {
        thread.arrays.insert(thread.arrays.end(), numbers.begin(), numbers.end());
        return;
    }
    if (r.opcode < wire::kFirstGlOpcode) own(client, thread, r);
    else draws(client, thread, r, std::move(numbers));
    thread.arrays.clear();
}

void TrimPlanner::own(Client& client, Thread& thread, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0);
    switch (r.opcode) {
    case wire::kOpMakeCurrent:
        thread.context = first;
        thread.draw = argumentWord(r, 1);
        thread.read = argumentWord(r, 2);
        return;
    case wire::kOpWindow: return window(client, r);
    case wire::kOpDestroyWindow: {
        const auto found = client.windows.find(first);
        if (found == client.windows.end()) return;
        client.unseen.insert(client.unseen.end(), found->second.unseen().begin(), found->second.unseen().end());
        client.windows.erase(found);
        return;
    }
    default: thread.plain = false; // whatever it is, between glBegin and glEnd
    }
}

void TrimPlanner::window(Client& client, const RecordView& r) {
    wire::WindowConfig config{};
    if (r.arguments.size() < 4 + sizeof config) return;
    std::memcpy(&config, r.arguments.data() + 4, sizeof config);
    if (!config.doubleBuffer && !config.isPbuffer) client.doubts.doubt("a window of its has one buffer only");
    if (config.stereo) client.doubts.doubt("it draws in stereo");
    client.drawable[argumentWord(r, 0)] = config.doubleBuffer && !config.isPbuffer;
}

void TrimPlanner::draws(Client& client, Thread& thread, const RecordView& r, RecordNumbers numbers) {
    const ContextState& context = client.contexts[thread.context];
    const Role role = roleOf(r.opcode);
    const bool draw = role == Role::Draw || role == Role::Begin || role == Role::Vertex || role == Role::End;
    if (before_ && (role == Role::Draw || role == Role::Begin)) {
        ++plan_.drawsBefore;
        ++client.drawsBefore;
    }
    if (settled_) return; // only what is doubted matters from here on
    if (role == Role::Clear && context.clears(argumentWord(r, 0))) client.windows[thread.draw].clear(context.clears(argumentWord(r, 0)));
    if (role == Role::Reads && context.compiling()) client.doubts.doubt("its display lists read the picture");
    if (role == Role::Reads && context.readsWindow()) client.windows[thread.read].look();
    if (thread.open && !draw && role != Role::Attribute) thread.plain = false;
    if (!draw) return;

    const bool droppable = before_ && context.drawsIntoWindow() && client.drawable[thread.draw];
    if (role == Role::Draw && !thread.open) {
        numbers.insert(numbers.begin(), thread.arrays.begin(), thread.arrays.end());
        if (droppable) client.windows[thread.draw].draw(numbers, client.doubts.writtenPlanes);
        return;
    }
    if (role == Role::Begin) {
        thread.open = thread.plain = true;
        thread.between.clear();
    }
    if (role == Role::Draw) thread.plain = false; // an error there
    thread.between.insert(thread.between.end(), numbers.begin(), numbers.end());
    if (role != Role::End) return;
    if (thread.open && thread.plain && droppable) client.windows[thread.draw].draw(thread.between, client.doubts.writtenPlanes);
    thread.open = false;
    thread.between.clear();
}

TrimPlan TrimPlanner::finish() {
    plan_.frames = frames_.frames();
    for (auto& [id, client] : clients_) {
        if (!client.doubts.why.empty()) {
            if (client.drawsBefore > 0) plan_.doubts[id] = client.doubts.why;
            continue;
        }
        for (auto& [window, draws] : client.windows) client.unseen.insert(client.unseen.end(), draws.unseen().begin(), draws.unseen().end());
        plan_.dropped.insert(plan_.dropped.end(), client.unseen.begin(), client.unseen.end());
    }
    std::ranges::sort(plan_.dropped);
    return std::move(plan_);
}

} // namespace mural::recording
