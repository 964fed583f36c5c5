// Messages with credit-based flow control over an endpoint, and the threads that wait for them.
//
// libfabric with manual progress advances only when polled, and the channel has no thread: waiting threads poll. Of two
// waiting threads one sleeps at the descriptors and the other on a condition variable; each notifies the other. Thread
// safety: all functions require the lock, which serialises the endpoint's calls; only sleeping releases it.
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
    enum class Side { Reading = 1, Writing = 2 }; // purpose of a wait; bits
    enum class End { Ready, DeadlinePassed, Ended };
    using Lock = std::unique_lock<std::mutex>;

    Channel(std::unique_ptr<Endpoint> endpoint, Greeting peer);

    [[nodiscard]] Lock lock() { return Lock(mutex_); }

    // Ended: this end was closed, the peer has ended, or the connection broke. ready() is evaluated first, so data
    // before the end counts.
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

    // Reading: the next message, in a slot that the reader owns until it returns it.
    struct Message {
        Endpoint::Slot slot = 0;
        std::span<const std::byte> bytes{};
    };
    [[nodiscard]] bool hasMessage() const { return !received_.empty(); }
    Message takeMessage();
    void giveBack(Endpoint::Slot slot);

    // Writing: buffers as much as there is room for. A message is sent when it is full, or by sendGathered().
    size_t gather(std::span<const std::byte> bytes);
    bool hasRoom();
    bool sendGathered(); // true: the buffer is empty
    [[nodiscard]] bool allSent() const { return sendsUnderWay_ == 0; }

    // Ends waits of both sides. Bye is sent after all buffered data; finished() then waits for the peer's reply, so the
    // peer can read everything before the connection ends.
    void close();
    bool finished();
    // Sleeps until finished, the deadline, or `stop`, which is evaluated after wakeAll().
    void drain(Lock& lock, Deadline deadline, const std::atomic<bool>& stop);
    void wakeAll();

    [[nodiscard]] bool ended() const { return closedHere_ || gone_; }
    [[nodiscard]] bool closedHere() const { return closedHere_; }
    bool checkForEnd(); // after processing received data
    // Error that broke the connection; empty: an orderly end, or none.
    [[nodiscard]] const std::string& fault() const { return fault_; }

private:
    void progress(Side by);
    void sleep(Lock& lock, Side side, Deadline deadline);
    End leave(End end);
    unsigned takeCompletions(); // returns Side bits with progress
    unsigned onReceived(const Endpoint::Completion& completion);
    void onCredits(uint16_t credits);
    void receiveInto(Endpoint::Slot slot);
    void sendControls();
    bool injected(const Header& header);
    void end(std::string fault);
    void end(long code);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::unique_ptr<Endpoint> endpoint_;
    unsigned sleeper_ = 0; // Side that sleeps at the descriptors; 0: none
    int waiting_ = 0;      // threads on the condition variable
    bool checkEvents_ = false;

    std::deque<Message> received_;
    uint16_t pendingCredits_ = 0;

    const size_t messageBytes_; // including its header; the minimum of both ends
    const uint16_t window_;     // credits of the peer
    uint16_t credits_;
    std::vector<Endpoint::Slot> freeSends_;
    size_t sendsUnderWay_ = 0;
    Endpoint::Slot gathering_ = 0; // 0: none, because slot 0 is for receiving
    size_t gatheredBytes_ = 0;     // including the header

    bool closedHere_ = false;
    bool byeSent_ = false;
    bool gone_ = false; // the peer has ended, and all its data has arrived
    std::string fault_;
};

} // namespace mural::fabric
