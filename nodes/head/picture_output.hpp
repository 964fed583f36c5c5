// The thread that shows and saves finished pictures; NativeWindows has one more for each program with windows.
//
//   wall picture (main window) → file sink (--out), all frames or those of --save
//   the same → windows of the wall (--display windows with several passes)
//   every window with a native X window → that window (--display app)
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/clock.hpp"
#include "common/main_window.hpp"
#include "nodes/head/native_windows.hpp"
#include "nodes/head/picture_assembler.hpp"
#include "nodes/output/picture_sink.hpp"

namespace mural {

// A canvas beside the first: it shows the wall's frames, too.
struct OtherCanvas {
    std::string name;
    bool pairs = false;                // its pictures are both eyes' (stackEyes)
    std::shared_ptr<PictureSink> file; // null: nothing is saved
    std::function<Result<std::unique_ptr<PictureSink>>()> openWall; // empty: nodes have windows of it, or nobody
};

struct PictureOutputConfig {
    std::vector<int64_t> saveFrames; // of the wall, from 1; empty: all
    int64_t lastFrame = 0;           // none behind it is saved: some come before the program has ended; 0: no limit
    bool toNativeWindows = false;    // --display app
    bool pairs = false;              // pictures are both eyes' (stackEyes)
    // Opens the sink of the native window that this picture, which is of no interest otherwise, belongs to.
    std::function<Result<std::unique_ptr<PictureSink>>(const WindowPicture& picture)> openWindow;
    // As of NativeWindowsConfig; needed with toNativeWindows.
    std::function<bool(const WindowPicture& picture, const Picture& whole)> giveToProgram = [](const WindowPicture&, const Picture&) { return false; };
    std::function<void(uint32_t client, bool isBlocked)> displayBlocked = [](uint32_t, bool) {};
    // Opens the windows of the wall, where the head has them; empty: nodes have, or nobody.
    std::function<Result<std::unique_ptr<PictureSink>>()> openWall;
    std::vector<OtherCanvas> canvases; // as of WindowPicture::others
    // When a picture has gone wherever it had to; by any thread of the output.
    std::function<void(uint32_t client, uint32_t frame)> done;
    std::function<void(const std::string&)> say;
};

struct OutputTotals {
    int64_t wallFrames = 0;  // of the main window that are out
    int64_t savedPictures = 0;
    int64_t lastSavedFrame = 0;
};

// add(), waitForRoom(), clientGone() and windowGone() from any thread.
class PictureOutput {
public:
    // file: null when nothing is saved. It is called by the output's thread only.
    PictureOutput(PictureOutputConfig config, std::unique_ptr<PictureSink> file);
    ~PictureOutput(); // drop(), and waits for the picture that is being shown

    void add(WindowPicture picture); // never blocks
    void waitForRoom();              // until the queue is short again, or the output ends
    void clientGone(uint32_t client);
    void windowGone(uint32_t client, uint32_t window); // after its last picture

    // Writes what is queued and completes the files; false when the deadline passed before that.
    bool finish(Deadline deadline);
    void drop(); // what is queued; nobody waits for room any more
    [[nodiscard]] OutputTotals totals() const;

private:
    void work();
    void show(const WindowPicture& picture);
    void finishFile();
    Result<void> give(PictureSink& sink, int64_t frame, const Picture& picture, bool pair);
    void save(int64_t frame, const Picture& picture);
    void showOnWall(int64_t frame, const Picture& picture);
    void showOnCanvas(size_t canvas, int64_t frame, const Picture& picture, bool saves);
    void forget(const WindowPicture& gone);

    const PictureOutputConfig config_;
    const std::set<int64_t> saveFrames_;
    std::unique_ptr<PictureSink> file_;
    bool fileFailed_ = false;
    bool saidEightBits_ = false;
    OwnedPicture eightBits_; // scratch memory of give()
    std::unique_ptr<PictureSink> wall_;
    bool wallFailed_ = false;
    struct Shown {
        std::unique_ptr<PictureSink> wall;
        bool fileFailed = false, wallFailed = false;
    };
    std::vector<Shown> canvases_; // as in the config
    MainWindow mainWindow_;
    NativeWindows natives_;

    mutable std::mutex mutex_; // what follows
    std::condition_variable changed_;
    std::deque<WindowPicture> queue_; // a null picture: the window, or (0) the client is gone
    OutputTotals totals_;
    bool finishing_ = false;
    bool dropped_ = false;
    bool ended_ = false;
    std::thread thread_;
};

} // namespace mural
