#include "nodes/output/windows/wall_windows.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <sys/eventfd.h>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "nodes/output/windows/wall_screen.hpp"

namespace mural {

namespace {

constexpr int64_t kIdleNs = kOverlayMs * kNsPerMs; // poll interval of an idle display, and of the overlay
constexpr size_t kMaxSpareBuffers = 32;

// A task for the windows' thread.
struct Job {
    std::function<Result<void>(WallScreen&)> work;
    Result<void> result;
    bool done = false;
};

} // namespace

// State shared by the windows' thread and its callers. The thread holds a reference, because a thread that an
// unresponsive server blocks is abandoned.
struct WallWindows::Shared {
    explicit Shared(const WallWindowsConfig& c) : config(c), wakeFd(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;
    ~Shared() {
        if (wakeFd >= 0) ::close(wakeFd);
    }

    const WallWindowsConfig config;
    const int wakeFd;
    std::thread thread;
    std::atomic<bool> closeRequested{false};

    std::mutex mutex; // guards the members below
    std::condition_variable changed;
    std::deque<std::shared_ptr<Job>> jobs;
    std::vector<OwnedPicture> buffers; // for pictures in transfer
    std::string description;
    bool stereo = false;
    std::string whyNotStereo;
    Result<void> opened;
    bool openKnown = false;
    bool stop = false;
    bool ended = false;

    void wake() const {
        const uint64_t one = 1;
        (void)!::write(wakeFd, &one, sizeof one);
    }
    Result<void> run(std::function<Result<void>(WallScreen&)> work, Deadline deadline);
    void serve();
    void serveJobs(WallScreen& screen);
    void end();
    OwnedPicture takeBuffer();
    void giveBuffers(std::vector<WallScreen::TileBuffer>& used);
};

namespace {

// Waits for a condition until the deadline. Call with the lock held.
template <class Condition>
bool waitUntil(std::condition_variable& changed, std::unique_lock<std::mutex>& lock, Deadline deadline,
               Condition condition) {
    return changed.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kNsPerS * 3600)), condition);
}

Error notInTime(const std::string& displayName) {
    return {fmt::format("the wall windows on the X display '{}' do not answer in time; check that "
                        "its server is not stopped",
                        displayName)};
}

} // namespace

// The main function of the windows' thread.
void WallWindows::Shared::serve() {
    {
        Result<std::unique_ptr<WallScreen>> screen = WallScreen::open(config);
        {
            const std::lock_guard lock(mutex);
            openKnown = true;
            if (screen) {
                description = screen.value()->describe();
                stereo = screen.value()->stereo();
                whyNotStereo = screen.value()->whyNotStereo();
            } else
                opened = screen.error();
            changed.notify_all();
        }
        while (screen) {
            {
                const std::lock_guard lock(mutex);
                if (stop) break;
            }
            serveJobs(*screen.value());
            (void)screen.value()->doWork(); // a permanent failure recurs in the next job
            if (screen.value()->closeRequested()) closeRequested = true;
            screen.value()->waitForEvents(wakeFd, kIdleNs);
            uint64_t count = 0;
            (void)!::read(wakeFd, &count, sizeof count);
        }
    }
    const std::lock_guard lock(mutex);
    ended = true;
    changed.notify_all();
}

void WallWindows::Shared::serveJobs(WallScreen& screen) {
    std::unique_lock lock(mutex);
    while (!jobs.empty() && !stop) {
        const std::shared_ptr<Job> job = jobs.front();
        jobs.pop_front();
        lock.unlock();
        Result<void> result = job->work(screen);
        lock.lock();
        job->result = std::move(result);
        job->done = true;
        changed.notify_all();
    }
}

Result<void> WallWindows::Shared::run(std::function<Result<void>(WallScreen&)> work, Deadline deadline) {
    auto job = std::make_shared<Job>();
    job->work = std::move(work);
    std::unique_lock lock(mutex);
    jobs.push_back(job);
    wake();
    if (waitUntil(changed, lock, deadline, [&] { return job->done; })) return job->result;
    std::erase(jobs, job); // cancels it before its start
    return notInTime(config.displayName);
}

void WallWindows::Shared::end() {
    bool finished = false;
    {
        std::unique_lock lock(mutex);
        stop = true;
        wake();
        finished = waitUntil(changed, lock, Deadline::inMs(config.showTimeoutMs), [&] { return ended; });
    }
    if (finished)
        thread.join();
    else
        thread.detach();
}

OwnedPicture WallWindows::Shared::takeBuffer() {
    const std::lock_guard lock(mutex);
    if (buffers.empty()) return {};
    OwnedPicture buffer = std::move(buffers.back());
    buffers.pop_back();
    return buffer;
}

void WallWindows::Shared::giveBuffers(std::vector<WallScreen::TileBuffer>& used) {
    const std::lock_guard lock(mutex);
    for (WallScreen::TileBuffer& buffer : used)
        for (OwnedPicture* const memory : {&buffer.picture, &buffer.right})
            if (buffers.size() < kMaxSpareBuffers) buffers.push_back(std::move(*memory));
}

Result<std::unique_ptr<WallWindows>> WallWindows::open(const WallWindowsConfig& config) {
    if (config.tiles.empty()) return Error{"a wall of windows needs at least one tile"};
    auto shared = std::make_shared<Shared>(config);
    if (shared->wakeFd < 0) return Error{"cannot create an event descriptor: too many open files; raise ulimit -n"};
    shared->thread = std::thread([shared] { shared->serve(); });
    Result<void> opened;
    {
        std::unique_lock lock(shared->mutex);
        const bool known =
            waitUntil(shared->changed, lock, Deadline::inMs(config.openTimeoutMs), [&] { return shared->openKnown; });
        opened = known ? shared->opened : Result<void>(notInTime(config.displayName));
    }
    std::unique_ptr<WallWindows> windows(new WallWindows(std::move(shared)));
    if (!opened) return opened.error(); // the destructor ends the thread
    log::debug(log::Topic::Output, config.tiles.size(), " wall windows on display \"", config.displayName, "\"");
    return windows;
}

WallWindows::WallWindows(std::shared_ptr<Shared> shared)
    : shared_(std::move(shared)), showTimeoutMs_(shared_->config.showTimeoutMs) {}

WallWindows::~WallWindows() {
    shared_->end();
    log::debug(log::Topic::Output, "wall windows are closed");
}

Result<void> WallWindows::show(size_t tile, const Picture& picture) {
    const TilePicture one{tile, picture};
    return showAll(std::span(&one, 1));
}

Result<void> WallWindows::showAll(std::span<const TilePicture> pictures) { return take(pictures, true); }

Result<void> WallWindows::drawAll(std::span<const TilePicture> pictures) { return take(pictures, false); }

Result<int64_t> WallWindows::present(int64_t atNs) {
    auto presentedNs = std::make_shared<int64_t>(0); // the thread may outlive this call
    const Deadline deadline = Deadline::at(std::max(atNs, monotonicNowNs()) + showTimeoutMs_ * kNsPerMs);
    const Result<void> done = shared_->run(
        [atNs, presentedNs](WallScreen& screen) {
            Result<void> shown = screen.present(atNs);
            *presentedNs = screen.presentedNs();
            return shown;
        },
        deadline);
    if (!done) return done.error();
    return *presentedNs;
}

// Copies the pictures: after the deadline the thread may still read them.
Result<void> WallWindows::take(std::span<const TilePicture> pictures, bool present) {
    const Deadline deadline = Deadline::inMs(showTimeoutMs_);
    const size_t tiles = shared_->config.tiles.size();
    auto buffers = std::make_shared<std::vector<WallScreen::TileBuffer>>();
    for (const TilePicture& shown : pictures) {
        if (shown.tile >= tiles) return Error{fmt::format("no wall window {}: there are {}", shown.tile, tiles)};
        if (shown.picture.empty()) return Error{fmt::format("the picture for wall window {} is empty", shown.tile)};
        buffers->push_back({shown.tile, shared_->takeBuffer(), {}});
        buffers->back().picture.assign(shown.picture);
        if (shown.right.empty()) continue;
        buffers->back().right = shared_->takeBuffer();
        buffers->back().right.assign(shown.right);
    }
    Shared* shared = shared_.get(); // a running thread keeps it alive
    return shared_->run(
        [buffers, shared, present](WallScreen& screen) {
            Result<void> done = screen.draw(*buffers);
            shared->giveBuffers(*buffers);
            return done && present ? screen.present() : done;
        },
        deadline);
}

Result<void> WallWindows::arrange(const std::vector<TileWindow>& tiles) {
    if (tiles.size() != shared_->config.tiles.size()) {
        return Error{fmt::format("{} places for {} wall windows; open the wall again for another number of tiles",
                                 tiles.size(), shared_->config.tiles.size())};
    }
    return shared_->run([tiles](WallScreen& screen) { return screen.arrange(tiles); }, Deadline::inMs(showTimeoutMs_));
}

bool WallWindows::closeRequested() const { return shared_->closeRequested; }

bool WallWindows::stereo() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->stereo;
}

std::string WallWindows::whyNotStereo() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->whyNotStereo;
}

std::string WallWindows::describe() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->description;
}

std::vector<TileWindow> placeTiles(std::span<const PixelViewport> tiles, int wallHeight) {
    std::vector<TileWindow> placed;
    for (const PixelViewport& tile : tiles) {
        TileWindow window;
        window.tile = tile;
        window.screenX = tile.x;
        window.screenY = wallHeight - tile.top();
        window.title = fmt::format("Mural {},{} {}x{}", tile.x, tile.y, tile.w, tile.h);
        placed.push_back(std::move(window));
    }
    return placed;
}

} // namespace mural
