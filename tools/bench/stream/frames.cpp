#include "tools/bench/stream/frames.hpp"

#include "recording/file_reader.hpp"
#include "recording/wall_frames.hpp"

namespace mural::bench {

Result<int64_t> readFrames(const std::string& path, const FrameReader& to) {
    auto reader = recording::FileReader::open(path);
    if (!reader) return reader.error();
    recording::WallFrames frames;
    for (size_t block = 0; block < (*reader)->blocks().size(); ++block) {
        auto raw = (*reader)->read(block);
        if (!raw) return raw.error();
        recording::EntryWalk walk(*raw);
        recording::Entry entry;
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
