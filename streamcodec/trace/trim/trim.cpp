#include "streamcodec/trace/trim/trim.hpp"

#include <set>

#include "streamcodec/trace/frame_numbers.hpp"
#include "streamcodec/trace/trace_writer.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/snapshot/stream_snapshot.hpp"
#include "streamcodec/snapshot/packet_splitter.hpp"
#include "streamcodec/registry_digest.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::trace {
namespace {

bool draws(uint16_t opcode) {
    const EffectKind kind = effectRuleOf(opcode).kind;
    return kind == EffectKind::Draw || kind == EffectKind::Begin || kind == EffectKind::CallList ||
           kind == EffectKind::CallLists;
}

// First pass: finds the needed part of earlier frames, and the requested frames. Records are numbered from 0 over the
// file.
class Survey {
public:
    Survey(int64_t first, int64_t last) : first_(first), last_(last) { begun(0); }

    // Returns false when nothing more is needed.
    bool entry(const Entry& e) {
        if (e.stream != 0) return packet(e);
        ClientEvent event;
        if (!parseEvent(e.payload, event)) return true;
        if (event.kind == Event::ClientCame && before)
            came.push_back({event.client, std::vector<std::byte>(e.payload.begin(), e.payload.end())});
        if (event.kind != Event::ClientGone) return true;
        frames_.clientGone(event.client);
        if (!before) return true;
        log.clientGone(event.client);
        std::erase_if(came, [&](const auto& c) { return c.first == event.client; });
        return true;
    }
    [[nodiscard]] int64_t frames() const { return frames_.frames(); }

    snapshot::LiveCommandLog log;
    // programs that existed at the start of the first frame
    std::vector<std::pair<uint32_t, std::vector<std::byte>>> came;
    bool before = true;       // before the first frame
    uint64_t beginRecord = 0; // first record of the first frame
    uint64_t shownFrom = 0;   // first visible swap
    uint64_t endRecord = 0;   // swap that ends the last frame
    uint64_t beganNs = 0;
    uint64_t drawsBefore = 0;

private:
    void begun(uint64_t timeNs) {
        if (!before || frames_.frames() + 1 < first_) return;
        before = false;
        beginRecord = number_;
        beganNs = timeNs;
        log.settlePending();
    }
    bool packet(const Entry& e) {
        wire::RecordWalk walk(e.payload);
        wire::RecordView r;
        for (; walk.next(r); ++number_) {
            drawsBefore += before && draws(r.opcode);
            log.record(e.stream, r, e.payload.subspan(r.offset, r.sizeBytes), !before);
            const int64_t ended = frames_.record(e.stream, r);
            if (ended == 0) continue;
            if (ended == first_) shownFrom = number_;
            endRecord = number_;
            if (ended >= last_) return false;
            if (before) {
                log.compactIfGrown();
                ++number_;
                begun(e.timeNs);
                --number_;
            }
        }
        return true;
    }

    const int64_t first_, last_;
    WallFrames frames_;
    uint64_t number_ = 0; // number of the record
};

class Copy {
public:
    Copy(const Survey& survey, TraceWriter& writer, TrimReport& report)
        : survey_(survey), writer_(writer), report_(report) {}

    // Writes the needed part of earlier frames.
    bool copyNeeded() {
        for (const auto& [client, event] : survey_.came)
            if (!put({0, 0, event})) return false;
        snapshot::PacketSplitter packets([&](uint32_t stream, std::span<const std::byte> payload) {
            if (failed_) failed_ = writer_.append({stream, 0, unseen(payload)});
        });
        survey_.log.forEach([&](uint32_t stream, std::span<const std::byte> records) { packets.add(stream, records); });
        packets.flush();
        return failed_.ok();
    }
    // Writes the requested frames. Returns false at their end, or on an error, which failed() has.
    bool entry(const Entry& e) {
        if (e.stream != 0) return packet(e);
        ClientEvent event;
        return number_ < survey_.beginRecord || !parseEvent(e.payload, event) || put({0, timeOf(e), e.payload});
    }
    [[nodiscard]] const Result<void>& failed() const { return failed_; }

private:
    [[nodiscard]] uint64_t timeOf(const Entry& e) const {
        return e.timeNs > survey_.beganNs ? e.timeNs - survey_.beganNs : 0;
    }

    bool packet(const Entry& e) {
        records_.clear();
        wire::RecordWalk walk(e.payload);
        wire::RecordView r;
        bool more = true;
        for (; more && walk.next(r); ++number_) {
            more = number_ < survey_.endRecord;
            if (number_ < survey_.beginRecord) continue;
            const size_t at = records_.size();
            records_.insert(records_.end(), e.payload.begin() + static_cast<std::ptrdiff_t>(r.offset),
                            e.payload.begin() + static_cast<std::ptrdiff_t>(r.offset + r.sizeBytes));
            // Swaps before the first frame become unseen; visible frames are renumbered from 1.
            const auto record = std::span(records_).subspan(at);
            if (number_ < survey_.shownFrom)
                snapshot::hideFrames(record);
            else
                numbers_.apply(e.stream, record);
        }
        return (records_.empty() || put({e.stream, timeOf(e), records_})) && more;
    }

    std::span<const std::byte> unseen(std::span<const std::byte> payload) {
        records_.assign(payload.begin(), payload.end());
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        while (walk.next(r)) {
            ++report_.recordsWritten;
            report_.drawsWritten += draws(r.opcode);
        }
        snapshot::hideFrames(records_);
        return records_;
    }

    bool put(const Entry& e) {
        failed_ = writer_.append(e);
        return failed_.ok();
    }

    const Survey& survey_;
    TraceWriter& writer_;
    TrimReport& report_;
    uint64_t number_ = 0;
    FrameNumbers numbers_;
    std::vector<std::byte> records_;
    Result<void> failed_;
};

} // namespace

Result<TrimReport> trim(TraceReader& reader, int64_t firstFrame, int64_t lastFrame, const std::string& path) {
    Survey survey(firstFrame, lastFrame);
    if (auto r = forEachEntry(reader, [&](const Entry& e) { return survey.entry(e); }); !r) return r.error();
    if (survey.frames() < lastFrame) return reader.noSuchFrames(survey.frames());
    survey.log.compact();
    auto writer = TraceWriter::create(path);
    if (!writer) return writer.error();
    TraceWriter& out = **writer;
    About about = reader.about();
    about.trimmed = "frames " + std::to_string(firstFrame) + " to " + std::to_string(lastFrame) +
                    (about.trimmed.empty() ? "" : " of " + about.trimmed);
    if (auto r = out.begin(about, wire::kVersion, registryDigest()); !r) return r.error();
    TrimReport report;
    report.recordsBefore = survey.beginRecord;
    report.drawsBefore = survey.drawsBefore;
    Copy copy(survey, out, report);
    if (!copy.copyNeeded()) return copy.failed().error();
    if (auto r = forEachEntry(reader, [&](const Entry& e) { return copy.entry(e); }); !r) return r.error();
    if (!copy.failed()) return copy.failed().error();
    if (auto r = out.flush(); !r) return r.error();
    if (auto r = out.finish(); !r) return r.error();
    report.frames = out.totals().frames;
    report.fileBytes = out.totals().fileBytes;
    return report;
}

} // namespace mural::trace
