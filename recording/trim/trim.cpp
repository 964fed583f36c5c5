#include "recording/trim/trim.hpp"

#include <algorithm>
#include <cstring>

#include "recording/file_writer.hpp"
#include "recording/trim/record_roles.hpp"
#include "recording/trim/trim_plan.hpp"
#include "streamcodec/registry_digest.hpp"

namespace mural::recording {
namespace {

// False from `take` ends it.
template <class Take> Result<void> forEachEntry(FileReader& reader, Take take) {
    for (size_t i = 0; i < reader.blocks().size(); ++i) {
        auto block = reader.read(i);
        if (!block) return block.error();
        EntryWalk walk(*block);
        Entry entry;
        while (walk.next(entry))
            if (!take(entry)) return {};
    }
    return {};
}

class Copy {
public:
    Copy(const TrimPlan& plan, FileWriter& writer, TrimReport& report) : plan_(plan), writer_(writer), report_(report) {}

    // False: no more is wanted, or failed() says why not.
    bool entry(const Entry& e) {
        ClientEvent event;
        if (e.stream == 0 && parseEvent(e.payload, event)) return plan_.goneClients.contains(event.client) || put(e, e.payload);
        return packet(e);
    }
    [[nodiscard]] const Result<void>& failed() const { return failed_; }

private:
    bool packet(const Entry& e) {
        const bool gone = plan_.goneClients.contains(wire::clientOf(e.stream));
        kept_.clear();
        RecordWalk walk(e.payload);
        RecordView r;
        bool more = true;
        for (; more && walk.next(r); ++number_) {
            more = number_ < plan_.endRecord;
            const bool before = number_ < plan_.shownFrom;
            const bool drop = gone || (dropped_ < plan_.dropped.size() && plan_.dropped[dropped_] == number_);
            if (!gone) dropped_ += drop;
            count(r, drop, before);
            if (drop) continue;
            const size_t at = kept_.size();
            kept_.insert(kept_.end(), e.payload.begin() + static_cast<std::ptrdiff_t>(r.offset), e.payload.begin() + static_cast<std::ptrdiff_t>(r.offset + r.sizeBytes));
            if (r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture) number(e.stream, r, at + r.sizeBytes - r.arguments.size(), before);
        }
        return (kept_.empty() || put(e, kept_)) && more;
    }

    // Pictures before the first frame are seen by nobody; those that are count from 1 again.
    void number(uint32_t stream, const RecordView& r, size_t argumentsAt, bool before) {
        if (r.arguments.size() < 8 || argumentWord(r, 1) == wire::kUnseenFrame) return;
        const uint32_t frame = before ? wire::kUnseenFrame : ++frames_[wire::clientOf(stream)];
        std::memcpy(kept_.data() + argumentsAt + 4, &frame, sizeof frame);
    }

    void count(const RecordView& r, bool drop, bool before) {
        report_.recordsBefore += before;
        report_.recordsDropped += drop;
        const Role role = roleOf(r.opcode);
        report_.drawsDropped += drop && (role == Role::Draw || role == Role::Begin);
    }

    bool put(const Entry& e, std::span<const std::byte> payload) {
        failed_ = writer_.append({e.stream, e.timeNs > plan_.beganNs ? e.timeNs - plan_.beganNs : 0, payload});
        return failed_.ok();
    }

    const TrimPlan& plan_;
    FileWriter& writer_;
    TrimReport& report_;
    uint64_t number_ = 0;
    size_t dropped_ = 0; // of plan_.dropped
    std::map<uint32_t, uint32_t> frames_;
    std::vector<std::byte> kept_;
    Result<void> failed_;
};

} // namespace

Result<TrimReport> trim(FileReader& reader, int64_t firstFrame, int64_t lastFrame, const std::string& path) {
    TrimPlanner planner(firstFrame, lastFrame);
    if (auto r = forEachEntry(reader, [&](const Entry& e) { return planner.entry(e); }); !r) return r.error();
    const TrimPlan plan = planner.finish();
    if (plan.frames < lastFrame) return Error{"the recording has " + std::to_string(plan.frames) + " frames; give some of them, such as 1-" + std::to_string(plan.frames)};
    auto writer = FileWriter::create(path);
    if (!writer) return writer.error();
    FileWriter& out = **writer;
    About about = reader.about();
    about.trimmed = "frames " + std::to_string(firstFrame) + " to " + std::to_string(lastFrame) + (about.trimmed.empty() ? "" : " of " + about.trimmed);
    if (auto r = out.begin(about, wire::kVersion, registryDigest()); !r) return r.error();
    TrimReport report;
    report.drawsBefore = plan.drawsBefore;
    report.doubts = plan.doubts;
    Copy copy(plan, out, report);
    if (auto r = forEachEntry(reader, [&](const Entry& e) { return copy.entry(e); }); !r) return r.error();
    if (!copy.failed()) return copy.failed().error();
    if (auto r = out.flush(); !r) return r.error();
    if (auto r = out.finish(); !r) return r.error();
    report.frames = out.totals().frames;
    report.fileBytes = out.totals().fileBytes;
    return report;
}

} // namespace mural::recording
