#include "transport/discovery/avahi_thread.hpp"

#include <chrono>
#include <thread>

#include "common/base/clock.hpp"
#include "transport/discovery/avahi_library.hpp"

namespace mural {

namespace {

constexpr int kPollSliceMs = 100;
constexpr int64_t kAgainMs = 5'000; // the daemon may start later
constexpr auto kMaxEnd = std::chrono::seconds(1);

using Shared = AvahiThread::Shared;

struct Conversation {
    const AvahiLibrary& avahi;
    std::shared_ptr<Shared> shared;
    const AvahiThread::Ready& ready;
    bool failed = false;
};

void clientChanged(AvahiClient* client, AvahiClientState state, void* data) {
    auto& c = *static_cast<Conversation*>(data);
    if (state == AVAHI_CLIENT_S_RUNNING) {
        c.shared->setTrouble({});
        c.ready(c.avahi, client, c.shared);
    } else if (state == AVAHI_CLIENT_FAILURE) {
        c.shared->setTrouble(std::string("Avahi: ") + c.avahi.strerror(c.avahi.clientErrno(client)));
        c.failed = true;
    }
}

// Runs until the daemon ends, or the thread is stopped.
void talk(const AvahiLibrary& avahi, const std::shared_ptr<Shared>& shared, const AvahiThread::Ready& ready,
          const AvahiThread::Lost& lost) {
    AvahiSimplePoll* poll = avahi.simplePollNew();
    if (!poll) return shared->setTrouble("Avahi: no memory");
    Conversation c{avahi, shared, ready};
    int code = 0;
    if (AvahiClient* client =
            avahi.clientNew(avahi.simplePollGet(poll), static_cast<AvahiClientFlags>(0), clientChanged, &c, &code)) {
        while (!shared->stop && !c.failed && avahi.simplePollIterate(poll, kPollSliceMs) == 0) {}
        lost();
        avahi.clientFree(client);
    } else {
        shared->setTrouble(std::string("Avahi: ") + avahi.strerror(code));
    }
    avahi.simplePollFree(poll);
}

void run(const std::shared_ptr<Shared>& shared, const AvahiThread::Ready& ready, const AvahiThread::Lost& lost) {
    std::string why;
    const AvahiLibrary* avahi = AvahiLibrary::get(why);
    if (!avahi) shared->setTrouble(why);
    while (avahi && !shared->stop) {
        talk(*avahi, shared, ready, lost);
        for (const Deadline again = Deadline::inMs(kAgainMs); !shared->stop && !again.passed();)
            std::this_thread::sleep_for(std::chrono::milliseconds(kPollSliceMs));
    }
    const std::lock_guard lock(shared->mutex);
    shared->ended = true;
    shared->changed.notify_all();
}

} // namespace

AvahiThread::AvahiThread(Ready ready, Lost lost) : shared_(std::make_shared<Shared>()) {
    std::thread([shared = shared_, ready = std::move(ready), lost = std::move(lost)] {
        run(shared, ready, lost);
    }).detach();
}

AvahiThread::~AvahiThread() {
    shared_->stop = true;
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, kMaxEnd, [this] { return shared_->ended; });
}

std::string AvahiThread::trouble() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->trouble;
}

} // namespace mural
