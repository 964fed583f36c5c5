// What of a recording is left out so that it begins at a later frame: found in one pass over its records, in their order.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "recording/entry.hpp"
#include "recording/trim/context_state.hpp"
#include "recording/trim/window_draws.hpp"
#include "recording/wall_frames.hpp"
#include "streamcodec/wire.hpp"

namespace mural::recording {

struct TrimPlan {
    std::vector<uint64_t> dropped;   // records by their numbers, counted from 0 over the file; sorted
    std::set<uint32_t> goneClients;  // programs that had gone before the first frame: nothing of them is needed
    uint64_t endRecord = 0;          // the record that ends the last frame
    uint64_t shownFrom = 0;          // the first swap that is seen
    uint64_t beganNs = 0;            // when the first frame began
    int64_t frames = 0;              // of the wall that there are at all, up to the last wanted
    uint64_t drawsBefore = 0;        // before the first frame
    std::map<uint32_t, std::string> doubts; // programs whose draws are all kept, and why
};

class TrimPlanner {
public:
    TrimPlanner(int64_t firstFrame, int64_t lastFrame) : first_(firstFrame), last_(lastFrame) {}
    // False: no more is needed.
    bool entry(const Entry& entry);
    TrimPlan finish();

private:
    struct Thread { // a stream
        uint32_t context = 0, draw = 0, read = 0;
        std::vector<RecordNumbers> blobs; // that no record has taken yet
        RecordNumbers arrays;             // client arrays of the draw that comes
        RecordNumbers between;            // of a glBegin that has not ended
        bool open = false, plain = false; // there is such a glBegin; nothing was in it that does more than draw
    };
    struct Client {
        Doubts doubts;
        std::map<uint32_t, ContextState> contexts;
        std::map<uint32_t, WindowDraws> windows;
        std::map<uint32_t, bool> drawable; // windows: the back buffer of one that is shown
        uint64_t drawsBefore = 0;
        std::vector<uint64_t> unseen; // of windows that are no more
    };

    bool packet(const Entry& entry);
    void record(Client& client, Thread& thread, const RecordView& r);
    void own(Client& client, Thread& thread, const RecordView& r);
    void draws(Client& client, Thread& thread, const RecordView& r, RecordNumbers numbers);
    void window(Client& client, const RecordView& r);
    RecordNumbers withBlobs(Thread& thread, const RecordView& r);

    const int64_t first_, last_;
    WallFrames frames_;
    uint64_t number_ = 0; // of the record
    bool before_ = true;  // the first frame has not begun
    bool settled_ = false; // the first frame has been shown: what was seen by then was seen
    std::map<uint32_t, Client> clients_;
    std::map<uint32_t, Thread> threads_;
    TrimPlan plan_;
};

} // namespace mural::recording
