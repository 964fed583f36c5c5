// The thread that shows and saves finished pictures. NativeWindows has a further thread for each program with windows.
//
// The wall picture (main window) goes to the file sink (--out): all frames, or the frames of --save. It also goes to
// the windows of the wall (--display windows with several passes). The picture of every window with a native X window
// goes to that window (--display app).
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/main_window.hpp"
#include "nodes/head/frames/native_windows.hpp"
#include "nodes/head/frames/picture_assembler.hpp"
#include "nodes/head/statistics/frame_statistics.hpp"
#include "nodes/output/picture_sink.hpp"

namespace mural {

// A further canvas. It shows the wall's frames as well.
struct OtherCanvas {
    std::string name;
    bool pairs = false;                                             // its pictures contain both eyes (stackEyes)
    std::shared_ptr<PictureSink> file;                              // null: not saved
    std::function<Result<std::unique_ptr<PictureSink>>()> openWall; // empty: the head opens no windows of it
};

struct PictureOutputConfig {
    std::vector<int64_t> saveFrames; // frames of the wall, from 1; empty: all
    int64_t lastFrame = 0;           // last saved frame; more may come before the program ends; 0: no limit
    bool toNativeWindows = false;    // --display app
    bool pairs = false;              // pictures contain both eyes (stackEyes)
    // Opens the sink of the native window that this picture belongs to. Uses no other data of the picture.
    std::function<Result<std::unique_ptr<PictureSink>>(const WindowPicture& picture)> openWindow;
    // The functions of NativeWindowsConfig; required with toNativeWindows.
    std::function<bool(const WindowPicture& picture, const Picture& whole)> giveToProgram =
        [](const WindowPicture&, const Picture&) { return false; };
    std::function<void(uint32_t client, bool isBlocked)> displayBlocked = [](uint32_t, bool) {};
    // Opens the windows of the wall. Empty: the head has no such windows.
    std::function<Result<std::unique_ptr<PictureSink>>()> openWall;
    std::vector<OtherCanvas> canvases;      // in the order of WindowPicture::others
    FrameStatistics* statistics = nullptr;  // null: none
    std::shared_ptr<const Overlay> overlay; // drawn in native windows; null: none
    // Set: saved pictures have the overlay as well. Contains the size of the wall in mm.
    std::optional<OverlayPlace> overlayInFiles;
    std::function<bool(uint32_t client)> beginOverlay = [](uint32_t) { return true; };
    std::function<void(uint32_t client)> endOverlay = [](uint32_t) {};
    // Called with each picture of the wall. Must not block. May be empty.
    std::function<void(int64_t wallFrame, const std::shared_ptr<const OwnedPicture>& picture)> offerToPages;
    // Called when a picture was passed to all its outputs, by any thread of the output.
    std::function<void(uint32_t client, uint32_t frame)> done;
};

struct OutputTotals {
    int64_t wallFrames = 0; // completed frames of the main window
    int64_t savedPictures = 0;
    int64_t lastSavedFrame = 0;
};

// Thread safety: add(), waitForRoom(), clientGone() and windowGone() may be called from any thread.
class PictureOutput {
public:
    // file: null if no picture is saved. Only the output's thread calls it.
    PictureOutput(PictureOutputConfig config, std::unique_ptr<PictureSink> file);
    ~PictureOutput(); // calls drop() and waits for the current picture

    void add(WindowPicture picture); // does not block
    void waitForRoom();              // waits until the queue is short or the output ends
    void clientGone(uint32_t client);
    void windowGone(uint32_t client, uint32_t window); // called after its last picture
    void closeWall(); // closes the wall windows after the queued pictures; a later picture opens them again

    // Writes the queued pictures and completes the files. Returns false if the deadline passes first.
    bool finish(Deadline deadline);
    void drop(); // drops queued pictures and ends waitForRoom()
    [[nodiscard]] OutputTotals totals() const;

private:
    void work();
    void take(const WindowPicture& picture);
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
    bool eightBitsReported_ = false;
    OverlayLayer fileOverlay_;
    OwnedPicture eightBits_; // scratch memory of give()
    std::unique_ptr<PictureSink> wall_;
    bool wallFailed_ = false;
    struct Shown {
        std::unique_ptr<PictureSink> wall;
        bool fileFailed = false, wallFailed = false;
    };
    std::vector<Shown> canvases_; // in the order of config_.canvases
    MainWindow mainWindow_;
    NativeWindows natives_;
    ThreadSpans spans_; // of thread_

    mutable std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    // null picture: the window is gone; window 0: the client; client 0: the wall windows close
    std::deque<WindowPicture> queue_;
    OutputTotals totals_;
    bool finishing_ = false;
    bool dropped_ = false;
    bool ended_ = false;
    std::thread thread_;
};

} // namespace mural
