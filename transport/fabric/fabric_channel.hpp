// Messages with credits over an endpoint, and who waits for them.
//
// Nothing happens in libfabric but when it is asked (manual progress), and no thread of our own asks: whoever waits does. Of
// two that wait, one sleeps at the descriptors, the other at a condition; what one finds for the other it tells it.
// Threads: all functions need the lock, by which an endpoint's calls are one at a time; only sleeping gives it up.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "transport/fabric/fabric_endpoint.hpp"

namespace mural::fabric {

class Channel {
public:
    enum class Side { Reading = 1, Writing = 2 }; // what a thread waits for; bits
    enum class End { Ready, DeadlinePassed, Ended };
    using Lock = std::unique_lock<std::mutex>;

    Channel(std::unique_ptr<Endpoint> endpoint, Greeting peer);

    [[nodiscard]] Lock lock() { return Lock(mutex_); }

    // Ended: this end was closed, the other is gone or the connection broke. ready() is asked first: what came before the end counts.
    template <class Ready> End waitUntil(Lock& lock, Side side, Deadline deadline, Ready ready) {
        while (!ready()) {
            progress(side);
            if (ready()) break;
            if (ended()) return leave(End::Ended);
            if (deadline.passed()) return leave(End::DeadlinePassed);
            sleep(lock, side, deadline);
        }
        return leave(End::Ready);
    }

    // Reading: the next message's bytes, in a slot that is the reader's until it gives it back.
    struct Message {
        Endpoint::Slot slot = 0;
        std::span<const std::byte> bytes{};
    };
    [[nodiscard]] bool hasMessage() const { return !received_.empty(); }
    Message takeMessage();
    void giveBack(Endpoint::Slot slot);

    // Writing: takes what there is room for; a message goes out when it is full, or by sendGathered.
    size_t gather(std::span<const std::byte> bytes);
    bool hasRoom();
    bool sendGathered(); // true: nothing is gathered any more
    [[nodiscard]] bool allSent() const { return sendsUnderWay_ == 0; }

    // From now on both sides' waits end. The other end is told once all that was gathered has gone out; finished() then waits
    // for its answer, so that it can read all before the connection ends.
    void close();
    bool finished();
    // Sleeps until finished, the deadline, or `stop`, which is looked at after wakeAll().
    void drain(Lock& lock, Deadline deadline, const std::atomic<bool>& stop);
    void wakeAll();

    [[nodiscard]] bool ended() const { return closedHere_ || gone_; }
    [[nodiscard]] bool closedHere() const { return closedHere_; }
    bool lookForEnd(); // after a look at what came meanwhile
    // Why it broke; empty: an orderly end, or none.
    [[nodiscard]] const std::string& fault() const { return fault_; }

private:
    void progress(Side by);
    void sleep(Lock& lock, Side side, Deadline deadline);
    End leave(End end);
    unsigned takeCompletions(); // bits of Side: who has got something
    unsigned onReceived(const Endpoint::Completion& completion);
    void onCredits(uint16_t credits);
    void receiveInto(Endpoint::Slot slot);
    void sendControls();
    bool injected(const Head& head);
    void end(std::string fault);
    void end(long code);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::unique_ptr<Endpoint> endpoint_;
    unsigned sleeper_ = 0; // the Side that sleeps at the descriptors; 0: none
    int waiting_ = 0;      // threads at the condition
    bool lookAtEvents_ = false;

    std::deque<Message> received_;
    uint16_t owedCredits_ = 0;

    const size_t messageBytes_; // with its head, as both ends can
    const uint16_t window_;     // the other end's
    uint16_t credits_;
    std::vector<Endpoint::Slot> freeSends_;
    size_t sendsUnderWay_ = 0;
    Endpoint::Slot gathering_ = 0; // 0: none, for slot 0 receives
    size_t gatheredBytes_ = 0;     // with the head

    bool closedHere_ = false;
    bool byeSent_ = false;
    bool gone_ = false; // the other end, and all it sent has come
    std::string fault_;
};

} // namespace mural::fabric
