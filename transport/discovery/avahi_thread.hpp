// Thread that communicates with the Avahi daemon. Destruction stops it and waits for a moment. A thread that hangs in a
// broken message bus is detached. The thread therefore owns its data.
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
    // State shared by the thread and its owner.
    struct Shared {
        std::atomic<bool> stop = false;
        std::mutex mutex;
        std::condition_variable changed;
        bool ended = false;
        std::string trouble; // reason for inactivity; empty: active
        void setTrouble(const std::string& why) {
            const std::lock_guard lock(mutex);
            trouble = why;
        }
    };
    // Called in the thread for each new client, also after the daemon has returned. `library` lives forever; objects
    // made for `client` end with it.
    using Ready =
        std::function<void(const AvahiLibrary& library, AvahiClient* client, const std::shared_ptr<Shared>& shared)>;
    // Called before a client is destroyed.
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
