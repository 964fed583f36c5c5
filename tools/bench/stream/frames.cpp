#include "tools/bench/stream/frames.hpp"

#include "streamcodec/trace/trace_reader.hpp"
#include "streamcodec/trace/wall_frames.hpp"

namespace mural::bench {

Result<int64_t> readFrames(const std::string& path, const FrameReader& to) {
    auto reader = trace::TraceReader::open(path);
    if (!reader) return reader.error();
    trace::WallFrames frames;
    for (size_t block = 0; block < (*reader)->blocks().size(); ++block) {
        auto raw = (*reader)->read(block);
        if (!raw) return raw.error();
        trace::EntryWalk walk(*raw);
        trace::Entry entry;
        while (walk.next(entry)) {
            if (entry.stream == 0) continue; // start or end of a program
            to.packet({entry.stream, entry.payload});
            const int64_t before = frames.frames();
            frames.packet(entry.stream, entry.payload);
            if (frames.frames() != before) to.ended(frames.frames());
        }
    }
    return frames.frames();
}

} // namespace mural::bench
