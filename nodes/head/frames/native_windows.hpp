// Shows pictures in the programs' own windows (--display app), with one thread per program. An X server that is stopped
// or grabbed therefore delays only the programs with windows on it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "nodes/head/frames/picture_assembler.hpp"
#include "nodes/head/statistics/frame_statistics.hpp"
#include "nodes/output/picture_sink.hpp"
#include "nodes/output/windows/overlay_layer.hpp"

namespace mural {

struct NativeWindowsConfig {
    bool pairs = false; // pictures contain both eyes (stackEyes)
    std::function<Result<std::unique_ptr<PictureSink>>(const WindowPicture& picture)> openWindow;
    // Returns true if the program has grabbed its X server and puts this picture itself. done() follows.
    std::function<bool(const WindowPicture& picture, const Picture& whole)> giveToProgram;
    std::function<void(uint32_t client, uint32_t frame)> done;    // the picture was shown or dropped
    std::function<void(uint32_t client, bool isBlocked)> blocked; // its X server stops or resumes to answer
    FrameStatistics* statistics = nullptr;                        // null: none
    std::shared_ptr<const Overlay> overlay;                       // drawn over the pictures; null: none
    // Required with overlay. beginOverlay returns false if the program reads its windows: no overlay is drawn, and
    // endOverlay follows when none is shown.
    std::function<bool(uint32_t client)> beginOverlay;
    std::function<void(uint32_t client)> endOverlay;
};

// The threads of the programs call the functions of the config.
class NativeWindows {
public:
    explicit NativeWindows(NativeWindowsConfig config);
    ~NativeWindows(); // calls drop()

    // One thread calls these; they never block. While a program's X server does not answer, only the latest picture of
    // each window is queued.
    void show(WindowPicture picture);
    void windowGone(uint32_t client, uint32_t window); // called after its last picture
    void clientGone(uint32_t client);
    void finish(); // shows queued pictures, unless their X server does not answer

    void drop(); // drops queued pictures; any thread

private:
    class Program;

    Program& programOf(uint32_t client);
    void removeEnded();

    const NativeWindowsConfig config_;
    std::mutex mutex_; // guards the members below
    bool dropped_ = false;
    std::map<uint32_t, std::unique_ptr<Program>> programs_;
    std::vector<std::unique_ptr<Program>> ending_;
};

} // namespace mural
