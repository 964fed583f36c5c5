#include "nodes/head/frames/native_windows.hpp"

#include <algorithm>
#include <chrono>

#include "common/log/log.hpp"
#include "nodes/head/statistics/output_spans.hpp"

namespace mural {

namespace {

constexpr size_t kMaxWindows = 64;
constexpr std::chrono::milliseconds kSlice{500};
constexpr std::chrono::milliseconds kOverlaySlice{50}; // the program may wait for the end of the overlay

} // namespace

class NativeWindows::Program {
public:
    Program(uint32_t client, const NativeWindowsConfig& config)
        : client_(client), config_(config), thread_([this] { work(); }) {}

    ~Program() {
        drop();
        thread_.join();
    }

    void add(WindowPicture picture) {
        std::vector<uint32_t> superseded;
        {
            const std::lock_guard lock(mutex_);
            if (isBlocked_)
                std::erase_if(queue_, [&](const WindowPicture& older) {
                    if (!older.picture || older.window != picture.window) return false;
                    superseded.push_back(older.frame);
                    return true;
                });
            queue_.push_back(std::move(picture));
            changed_.notify_all();
        }
        for (const uint32_t frame : superseded) config_.done(client_, frame);
    }

    // Ends the thread when the queue is empty or its X server does not answer.
    void end() {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        changed_.notify_all();
    }

    void drop() {
        const std::lock_guard lock(mutex_);
        dropped_ = true;
        changed_.notify_all();
    }

    void waitEnded() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return ended_; });
    }

    bool hasEnded() {
        const std::lock_guard lock(mutex_);
        return ended_;
    }

private:
    struct Window {
        explicit Window(std::shared_ptr<const Overlay> shown) : overlay(std::move(shown)) {}

        std::unique_ptr<PictureSink> sink; // null: the window could not be opened
        OverlayLayer overlay;
        WindowPicture latest;    // the picture that it shows; none without overlay
        bool hasOverlay = false; // its picture was drawn with the overlay
    };

    void work() {
        std::unique_lock lock(mutex_);
        while (!dropped_ && !(ending_ && (queue_.empty() || isBlocked_))) {
            if (queue_.empty()) {
                if (changed_.wait_for(lock, isAnnounced_ ? kOverlaySlice : kSlice) == std::cv_status::no_timeout)
                    continue;
                lock.unlock();
                redrawOutdated();
                lock.lock();
                continue;
            }
            const WindowPicture picture = std::move(queue_.front());
            queue_.pop_front();
            lock.unlock();
            if (picture.picture)
                recordOutput(config_.statistics, spans_, client_, picture.frame, "window", [&] { take(picture); });
            else
                forget(picture.window);
            lock.lock();
        }
        queue_.clear();
        lock.unlock();
        if (isAnnounced_) config_.endOverlay(client_);
        windows_.clear();
        lock.lock();
        ended_ = true;
        changed_.notify_all();
    }

    void take(const WindowPicture& picture) {
        if (config_.giveToProgram(picture, wholeOf(picture))) {
            if (const auto older = windows_.find(picture.window); older != windows_.end()) {
                older->second.latest = {};
                older->second.hasOverlay = false;
            }
            return;
        }
        showInWindow(picture);
        if (isAnnounced_ && !mayDrawOverlay()) redrawOutdated();
        config_.done(client_, picture.frame);
    }

    // Returns one picture, with both eyes side by side for pairs, because the program's window holds a single picture.
    Picture wholeOf(const WindowPicture& picture) {
        const Picture view = picture.picture->view();
        if (!config_.pairs) return view;
        sideBySide(eyesOfStack(view), bothEyes_);
        return bothEyes_.view();
    }

    void showInWindow(const WindowPicture& picture) {
        Window& window = windowOf(picture);
        window.latest = config_.overlay ? picture : WindowPicture();
        while (window.sink != nullptr) {
            const auto shown = window.sink->show(picture.frame, withOverlay(window, picture, mayDrawOverlay()));
            const bool isBlocked = !shown && window.sink->isBlocked();
            setBlocked(isBlocked);
            if (!shown && complained_.insert(picture.window).second)
                log::warning(log::Topic::Output, shown.error().message);
            if (shown) complained_.erase(picture.window);
            if (!isBlocked || isSuperseded(picture.window)) return;
        }
    }

    Picture withOverlay(Window& window, const WindowPicture& picture, bool may) {
        const Picture whole = wholeOf(picture);
        window.hasOverlay = may;
        if (!may) return whole;
        OverlayPlace place;
        place.title = "window of the program";
        place.wallWidth = whole.width;
        place.wallHeight = whole.height;
        return window.overlay.over(whole, std::move(place));
    }

    // Returns whether pictures have the overlay now. A program that reads its windows never finds it there.
    bool mayDrawOverlay() {
        if (readsWindows_ || !config_.overlay || config_.overlay->mode() == OverlayMode::Off) return false;
        isAnnounced_ = true;
        readsWindows_ = !config_.beginOverlay(client_);
        return !readsWindows_;
    }

    // Shows the latest pictures again after a change of the overlay. An error recurs with the next picture.
    void redrawOutdated() {
        const bool may = mayDrawOverlay();
        for (auto& [id, window] : windows_)
            if (window.sink && window.latest.picture && (may ? window.overlay.isOutdated() : window.hasOverlay))
                (void)window.sink->show(window.latest.frame, withOverlay(window, window.latest, may));
        if (may || !isAnnounced_) return;
        isAnnounced_ = false;
        config_.endOverlay(client_);
    }

    Window& windowOf(const WindowPicture& picture) {
        const auto found = windows_.find(picture.window);
        if (found != windows_.end()) return found->second;
        if (windows_.size() >= kMaxWindows) windows_.clear(); // most of them are closed
        auto opened = config_.openWindow(picture);
        if (!opened && complained_.insert(picture.window).second)
            log::warning(log::Topic::Output, opened.error().message);
        Window& window = windows_.try_emplace(picture.window, config_.overlay).first->second;
        if (opened) window.sink = std::move(*opened);
        return window;
    }

    void setBlocked(bool isBlocked) {
        {
            const std::lock_guard lock(mutex_);
            if (isBlocked_ == isBlocked) return;
            isBlocked_ = isBlocked;
        }
        config_.blocked(client_, isBlocked);
    }

    // Returns whether the picture need not be shown any more.
    bool isSuperseded(uint32_t window) {
        const std::lock_guard lock(mutex_);
        return dropped_ || ending_ ||
               std::ranges::any_of(queue_, [&](const WindowPicture& later) { return later.window == window; });
    }

    void forget(uint32_t window) {
        windows_.erase(window);
        complained_.erase(window);
    }

    const uint32_t client_;
    const NativeWindowsConfig& config_;
    OwnedPicture bothEyes_; // used by thread_, as the members up to mutex_
    std::map<uint32_t, Window> windows_;
    std::set<uint32_t> complained_;
    ThreadSpans spans_;
    bool readsWindows_ = false;
    bool isAnnounced_ = false; // the program waits before it reads a window

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::deque<WindowPicture> queue_; // null picture: the window is gone
    bool isBlocked_ = false;
    bool ending_ = false, dropped_ = false, ended_ = false;
    std::thread thread_;
};

NativeWindows::NativeWindows(NativeWindowsConfig config) : config_(std::move(config)) {}

NativeWindows::~NativeWindows() { drop(); }

NativeWindows::Program& NativeWindows::programOf(uint32_t client) {
    auto& program = programs_[client];
    if (!program) program = std::make_unique<Program>(client, config_);
    return *program;
}

void NativeWindows::show(WindowPicture picture) {
    const std::lock_guard lock(mutex_);
    removeEnded();
    if (dropped_) return;
    Program& program = programOf(picture.client);
    program.add(std::move(picture));
}

void NativeWindows::windowGone(uint32_t client, uint32_t window) {
    WindowPicture gone;
    gone.client = client;
    gone.window = window;
    const std::lock_guard lock(mutex_);
    const auto found = programs_.find(client);
    if (found != programs_.end()) found->second->add(std::move(gone));
}

void NativeWindows::clientGone(uint32_t client) {
    const std::lock_guard lock(mutex_);
    const auto found = programs_.find(client);
    if (found == programs_.end()) return;
    found->second->end();
    ending_.push_back(std::move(found->second));
    programs_.erase(found);
}

void NativeWindows::finish() {
    std::vector<Program*> all;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [client, program] : programs_) all.push_back(program.get());
        for (const auto& program : ending_) all.push_back(program.get());
    }
    for (Program* program : all) program->end();
    for (Program* program : all) program->waitEnded();
}

void NativeWindows::drop() {
    const std::lock_guard lock(mutex_);
    dropped_ = true;
    for (const auto& [client, program] : programs_) program->drop();
    for (const auto& program : ending_) program->drop();
}

// Requires mutex_. The joins return at once.
void NativeWindows::removeEnded() {
    std::erase_if(ending_, [](const auto& program) { return program->hasEnded(); });
}

} // namespace mural
