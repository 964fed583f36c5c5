#include "streamcodec/trace/dump/dump.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fnmatch.h>
#include <map>

#include "streamcodec/trace/dump/record_text.hpp"
#include "streamcodec/trace/wall_frames.hpp"
#include "streamcodec/command_table.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::trace {
namespace {

bool fitsPattern(const std::string& pattern, const std::string& name) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

struct Count {
    uint64_t calls = 0;
    uint64_t bytes = 0;
};

class Dump {
public:
    Dump(const DumpOptions& options, const std::function<bool(const std::string&)>& line)
        : options_(options), line_(line), absent_(options.calls) {}

    // Returns false to stop.
    bool entry(const Entry& e) {
        frame_ = frames_.frames() + 1;
        if (frame_ > options_.lastFrame) return false;
        return e.stream == 0 ? event(e) : packet(e);
    }
    bool finish() { return !options_.summary || (endFrame() && totals()); }
    [[nodiscard]] const std::vector<std::string>& absent() const { return absent_; }

private:
    [[nodiscard]] bool inRange() const { return frame_ >= options_.firstFrame && frame_ <= options_.lastFrame; }

    struct Kind {
        std::string name;
        bool wanted = false;
    };
    // Display properties of a command.
    const Kind& kindOf(uint16_t opcode) {
        const auto [at, isNew] = kinds_.try_emplace(opcode);
        Kind& kind = at->second;
        if (!isNew) return kind;
        kind.name = recordName(opcode);
        const auto fitsIt = [&](const std::string& pattern) { return fitsPattern(pattern, kind.name); };
        kind.wanted = options_.calls.empty() || std::ranges::any_of(options_.calls, fitsIt);
        std::erase_if(absent_, fitsIt);
        return kind;
    }

    bool event(const Entry& e) {
        ClientEvent event;
        if (!parseEvent(e.payload, event)) return true;
        if (event.kind == Event::ClientGone) frames_.clientGone(event.client);
        if (!inRange() || options_.summary || !options_.calls.empty()) return true;
        return line_(event.kind == Event::ClientCame ? fmt::format("{:6} {}    program started: {}, pid {}", frame_,
                                                                   event.client, event.name, event.pid)
                                                     : fmt::format("{:6} {}    program ended", frame_, event.client));
    }

    bool packet(const Entry& e) {
        wire::RecordWalk walk(e.payload);
        wire::RecordView r;
        while (walk.next(r)) {
            frame_ = frames_.frames() + 1;
            const bool shows = inRange();
            const bool go = options_.summary ? !shows || count(r) : call(e.stream, r, shows);
            const bool ended = frames_.record(e.stream, r) > 0;
            if (!go || (ended && shows && options_.summary && !endFrame())) return false;
        }
        if (walk.malformed() && inRange() && !options_.summary)
            return line_(
                fmt::format("{:6} {}.{:<2} malformed record", frame_, wire::clientOf(e.stream), e.stream & 0xffff));
        return true;
    }

    bool call(uint32_t stream, const wire::RecordView& r, bool shows) {
        const std::string text = recordText(r, blobs_[stream]); // always formatted, because it consumes its blobs
        if (!shows || !kindOf(r.opcode).wanted) return true;
        return line_(fmt::format("{:6} {}.{:<2} {}", frame_, wire::clientOf(stream), stream & 0xffff, text));
    }

    bool count(const wire::RecordView& r) {
        const Kind& kind = kindOf(r.opcode);
        if (!kind.wanted) return true;
        for (Count* c : {&ofFrame_[kind.name], &total_[kind.name]}) {
            ++c->calls;
            c->bytes += r.sizeBytes;
        }
        return true;
    }

    bool endFrame() {
        if (ofFrame_.empty()) return true;
        Count all;
        for (const auto& [name, c] : ofFrame_) {
            all.calls += c.calls;
            all.bytes += c.bytes;
        }
        if (!line_(fmt::format("frame {}: {} calls, {} bytes", frame_, all.calls, all.bytes))) return false;
        const bool shown = table(ofFrame_);
        ofFrame_.clear();
        return shown;
    }

    bool totals() {
        if (!line_("all frames:")) return false;
        return table(total_);
    }

    bool table(const std::map<std::string, Count>& counts) {
        std::vector<std::pair<std::string, Count>> rows(counts.begin(), counts.end());
        std::ranges::stable_sort(rows, [](const auto& a, const auto& b) { return a.second.bytes > b.second.bytes; });
        return std::ranges::all_of(rows, [&](const auto& row) {
            return line_(fmt::format("  {:10} {:12} bytes  {}", row.second.calls, row.second.bytes, row.first));
        });
    }

    const DumpOptions& options_;
    const std::function<bool(const std::string&)>& line_;
    WallFrames frames_;
    int64_t frame_ = 1; // current frame
    std::map<uint32_t, StreamBlobs> blobs_;
    std::map<uint16_t, Kind> kinds_;
    std::vector<std::string> absent_; // patterns without a match
    std::map<std::string, Count> ofFrame_, total_;
};

Result<bool> hasUnendedFrame(TraceReader& reader) {
    WallFrames frames;
    bool unended = false;
    const auto read = forEachEntry(reader, [&](const Entry& e) {
        unended = true;
        ClientEvent event;
        if (e.stream == 0 && parseEvent(e.payload, event) && event.kind == Event::ClientGone)
            frames.clientGone(event.client);
        if (e.stream == 0) return true;
        wire::RecordWalk walk(e.payload);
        wire::RecordView r;
        while (walk.next(r)) unended = frames.record(e.stream, r) == 0;
        return true;
    });
    return read ? Result<bool>(unended) : read.error();
}

} // namespace

bool fitsSomeCall(const std::string& pattern) {
    for (uint16_t opcode = 1; opcode < wire::kFirstGlOpcode; ++opcode)
        if (fitsPattern(pattern, recordName(opcode))) return true;
    return std::ranges::any_of(commandTable(),
                               [&](const CommandInfo& command) { return fitsPattern(pattern, command.name); });
}

Result<void> checkFrames(TraceReader& reader, int64_t lastFrame) {
    if (lastFrame <= reader.frames()) return {};
    if (lastFrame - 1 > reader.frames()) return reader.noSuchFrames(reader.frames());
    const auto unended = hasUnendedFrame(reader);
    if (!unended) return unended.error();
    return unended.value() ? Result<void>() : reader.noSuchFrames(reader.frames());
}

Result<DumpReport> dump(TraceReader& reader, const DumpOptions& options,
                        const std::function<bool(const std::string&)>& line) {
    Dump dump(options, line);
    if (auto read = forEachEntry(reader, [&](const Entry& e) { return dump.entry(e); }); !read) return read.error();
    dump.finish();
    return DumpReport{dump.absent()};
}

} // namespace mural::trace
