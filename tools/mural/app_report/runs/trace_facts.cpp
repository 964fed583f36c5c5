#include "tools/mural/app_report/runs/trace_facts.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/trace/dump/record_text.hpp"
#include "streamcodec/trace/trace_reader.hpp"
#include "streamcodec/trace/wall_frames.hpp"

namespace mural::cli {

namespace {

constexpr uint32_t kColorBufferBit = 0x4000; // GL_COLOR_BUFFER_BIT

// Walks over the records of a trace.
class TraceCount {
public:
    explicit TraceCount(TraceFacts& facts) : f_(facts) {}

    void packet(uint32_t stream, std::span<const std::byte> payload) {
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        while (walk.next(r)) record(stream, r);
    }
    void clientGone(uint32_t client) { frames_.clientGone(client); }

private:
    void record(uint32_t stream, const wire::RecordView& r) {
        if (r.opcode == wire::kOpCreateContext) {
            ++f_.contexts[contextName(wire::argumentWord(r, 2), wire::argumentWord(r, 3), wire::argumentWord(r, 4),
                                      wire::argumentWord(r, 5))];
        } else if (r.opcode == wire::kOpWindow) {
            sizes_[{wire::clientOf(stream), wire::argumentWord(r, 0)}] = {wire::argumentWord(r, 1),
                                                                          wire::argumentWord(r, 2)};
        } else if (r.opcode >= wire::kFirstGlOpcode) {
            ++f_.calls[nameOf(r.opcode)];
            cleared_ = cleared_ || clearsColour(r);
        }
        countBytes(stream, r);
        if (r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture) noteSize(stream, r);
        if (frames_.record(stream, r) == 0) return;
        ++f_.frames;
        f_.clearedFrames += cleared_;
        cleared_ = false;
        if (f_.frames == 1) f_.firstFrameBytes = f_.textureBytes + f_.bufferBytes + f_.otherBytes;
    }

    // A value above the size of a record precedes its command.
    void countBytes(uint32_t stream, const wire::RecordView& r) {
        int64_t& waiting = waiting_[stream];
        if (r.opcode == wire::kOpBlobBegin || r.opcode == wire::kOpBlobData) {
            waiting += static_cast<int64_t>(r.sizeBytes);
            return;
        }
        const int64_t bytes = static_cast<int64_t>(r.sizeBytes) + std::exchange(waiting, 0);
        if (hasTrait(r.opcode, Trait::BufferContents) || r.opcode == wire::kOpBufferBytes ||
            r.opcode == wire::kOpClientArrays)
            f_.bufferBytes += bytes;
        else if (isTextureUpload(r.opcode))
            f_.textureBytes += bytes;
        else
            f_.otherBytes += bytes;
    }

    void noteSize(uint32_t stream, const wire::RecordView& r) {
        const auto found = sizes_.find({wire::clientOf(stream), wire::argumentWord(r, 0)});
        if (found != sizes_.end()) f_.windowSizes.insert(found->second);
    }

    static bool clearsColour(const wire::RecordView& r) {
        return (hasTrait(r.opcode, Trait::Clear) && (wire::argumentWord(r, 0) & kColorBufferBit) != 0) ||
               hasTrait(r.opcode, Trait::ClearBuffer, Trait::ClearNamed);
    }
    static bool isTextureUpload(uint16_t opcode) {
        const EffectKind kind = effectOf(opcode).kind;
        return kind == EffectKind::TexImage || kind == EffectKind::TexSubImage;
    }
    const std::string& nameOf(uint16_t opcode) {
        std::string& name = names_[opcode];
        if (name.empty()) name = trace::recordName(opcode);
        return name;
    }

    TraceFacts& f_;
    trace::WallFrames frames_;
    std::map<uint16_t, std::string> names_;
    std::map<uint32_t, int64_t> waiting_; // bytes of values before their command, by stream
    std::map<std::pair<uint32_t, uint32_t>, std::pair<uint32_t, uint32_t>> sizes_; // of windows, by client and window
    bool cleared_ = false;
};

} // namespace

std::string contextName(uint32_t api, uint32_t major, uint32_t minor, uint32_t profile) {
    if (api == static_cast<uint32_t>(wire::Api::Es1)) return "OpenGL ES 1";
    if (api == static_cast<uint32_t>(wire::Api::Es2)) return fmt::format("OpenGL ES {}.{}", std::max(major, 2u), minor);
    if (major < 3 || (major == 3 && minor < 1)) return "OpenGL, any version";
    const bool profiles = major > 3 || minor >= 2;
    return fmt::format("OpenGL {}.{}{}", major, minor,
                       !profiles            ? ""
                       : (profile & 2) != 0 ? " compatibility"
                                            : " core");
}

TraceFacts readTraceFacts(const std::string& file) {
    TraceFacts facts;
    auto opened = trace::TraceReader::open(file);
    if (!opened) {
        facts.problem = opened.error().message;
        return facts;
    }
    trace::TraceReader& reader = **opened;
    if (!reader.about().nodes.empty()) facts.nodesGl = reader.about().nodes.front();
    TraceCount count(facts);
    const auto read = trace::forEachEntry(reader, [&](const trace::Entry& e) {
        trace::ClientEvent event;
        if (e.stream != 0)
            count.packet(e.stream, e.payload);
        else if (trace::parseEvent(e.payload, event) && event.kind == trace::Event::ClientGone)
            count.clientGone(event.client);
        return true;
    });
    if (!read) facts.problem = read.error().message;
    facts.complete = read.ok() && reader.notice().empty();
    return facts;
}

} // namespace mural::cli
