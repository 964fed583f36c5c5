// The programs' own windows (--display app). Each program's pictures are shown by a thread of their own: an X server that
// does not answer, stopped or grabbed by somebody, holds up the programs with windows on it and nothing else.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "nodes/head/picture_assembler.hpp"
#include "nodes/output/picture_sink.hpp"

namespace mural {

struct NativeWindowsConfig {
    bool pairs = false; // pictures are both eyes' (stackEyes)
    std::function<Result<std::unique_ptr<PictureSink>>(const WindowPicture& picture)> openWindow;
    // True: the program has grabbed its X server and puts this picture itself; done() follows.
    std::function<bool(const WindowPicture& picture, const Picture& whole)> giveToProgram;
    std::function<void(uint32_t client, uint32_t frame)> done;   // the picture is shown, or never will be
    std::function<void(uint32_t client, bool isBlocked)> blocked; // its X server does not answer, or does again
    std::function<void(const std::string&)> say;
};

// The functions of the config are called by the threads.
class NativeWindows {
public:
    explicit NativeWindows(NativeWindowsConfig config);
    ~NativeWindows(); // drop()

    // One thread; they never block. While a program's X server does not answer, only the latest picture of a window waits.
    void show(WindowPicture picture);
    void windowGone(uint32_t client, uint32_t window); // after its last picture
    void clientGone(uint32_t client);
    void finish(); // shows what waits; not what an X server does not take

    void drop(); // what waits; any thread

private:
    class Program;

    Program& programOf(uint32_t client);
    void removeEnded();

    const NativeWindowsConfig config_;
    std::mutex mutex_; // of what follows
    bool dropped_ = false;
    std::map<uint32_t, std::unique_ptr<Program>> programs_;
    std::vector<std::unique_ptr<Program>> ending_;
};

} // namespace mural
