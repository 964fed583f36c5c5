// A thread that talks to the Avahi daemon. It is asked to end and waited for a moment; one that hangs in a dead message bus
// is left behind, so what it uses is its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

struct AvahiClient;

namespace mural {

struct AvahiLibrary;

class AvahiThread {
public:
    // What the thread and its owner share.
    struct Shared {
        std::atomic<bool> stop = false;
        std::mutex mutex;
        std::condition_variable changed;
        bool ended = false;
        std::string trouble; // why nothing happens now; empty: it does
        void setTrouble(const std::string& why) {
            const std::lock_guard lock(mutex);
            trouble = why;
        }
    };
    // In the thread, when there is a client, and again when the daemon has come back. `library` lives for ever; what is made
    // for `client` ends with it.
    using Ready = std::function<void(const AvahiLibrary& library, AvahiClient* client, const std::shared_ptr<Shared>& shared)>;
    // Before a client is given back.
    using Lost = std::function<void()>;

    AvahiThread(Ready ready, Lost lost);
    ~AvahiThread();
    AvahiThread(const AvahiThread&) = delete;
    AvahiThread& operator=(const AvahiThread&) = delete;

    [[nodiscard]] std::string trouble() const;

private:
    std::shared_ptr<Shared> shared_;
};

} // namespace mural
