#include "nodes/input/program_input.hpp"

#include <chrono>
#include <sys/socket.h>
#include <utility>

namespace mural::input {

ProgramInput::ProgramInput(std::function<void(int viewer, uint32_t number)> onSent)
    : onSent_(std::move(onSent)), thread_([this] { work(); }) {}

ProgramInput::~ProgramInput() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        changed_.notify_all();
    }
    // A frozen X server must not keep this process.
    constexpr std::chrono::milliseconds kPatience{300};
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPatience, [this] { return openFd_ < 0; });
    if (openFd_ >= 0) shutdown(openFd_, SHUT_RDWR);
    lock.unlock();
    thread_.join();
}

void ProgramInput::use(const ProgramDisplay& display) {
    if (current_ == display) return;
    current_ = display;
    add({0, {}, display});
}

bool ProgramInput::send(int viewer, const InputEvent& event) { return add({viewer, event, std::nullopt}); }

void ProgramInput::releaseAll() {
    InputEvent event;
    event.kind = InputKind::Blur;
    add({0, event, std::nullopt});
}

bool ProgramInput::add(Entry entry) {
    const std::lock_guard lock(mutex_);
    // Releases are never dropped, otherwise a key would stay down.
    const bool isRelease = entry.viewer == 0 || entry.event.kind == InputKind::Blur ||
                           entry.event.kind == InputKind::Up ||
                           (entry.event.kind == InputKind::Key && !entry.event.isDown);
    if (queue_.size() >= kMaxWaiting * (isRelease ? 2 : 1)) return false;
    queue_.push_back(std::move(entry));
    changed_.notify_all();
    return true;
}

std::string ProgramInput::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

void ProgramInput::work() {
    std::unique_ptr<DisplayInput> input;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (queue_.empty()) {
            changed_.wait_for(lock, std::chrono::seconds(60));
            continue;
        }
        const Entry entry = std::move(queue_.front());
        queue_.pop_front();
        lock.unlock();
        perform(input, entry);
        lock.lock();
        openFd_ = input ? input->fd() : -1;
    }
    lock.unlock();
    input.reset();
    lock.lock();
    openFd_ = -1;
    changed_.notify_all();
}

void ProgramInput::perform(std::unique_ptr<DisplayInput>& input, const Entry& entry) {
    if (entry.display) {
        input.reset();
        auto opened = DisplayInput::open(*entry.display);
        const std::lock_guard lock(mutex_);
        problem_ = opened ? "" : opened.error().message;
        if (opened) input = std::move(*opened);
    } else if (input && !input->isLost()) {
        input->send(entry.event);
        {
            const std::lock_guard lock(mutex_);
            problem_ = input->refusal();
        }
        if (entry.viewer != 0) onSent_(entry.viewer, entry.event.number);
    }
    holdsButtons_ = input && input->holdsButtons();
}

} // namespace mural::input
