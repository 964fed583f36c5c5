// Processes of this machine that read objects over connections, for the benchmarks.
#pragma once

#include <functional>
#include <memory>
#include <sys/types.h>
#include <vector>

#include <mural/object_reader.hpp>

#include "objects/core/message_sink.hpp"
#include "transport/connection.hpp"

namespace mural::bench {

// Child processes, which end with this object. Create them before the process has threads.
class ChildProcesses {
public:
    ChildProcesses() = default;
    ChildProcesses(const ChildProcesses&) = delete;
    ChildProcesses& operator=(const ChildProcesses&) = delete;
    ~ChildProcesses();
    // Starts a child that runs `work` and ends.
    void start(const std::function<void()>& work);

private:
    std::vector<pid_t> children_;
};

enum class LineKind : uint8_t { SharedMemory, Tcp };

// A writer's lines to N processes that acknowledge what they read with one byte: 1 for the right contents.
class ReaderProcesses : public objects::MessageSink {
public:
    // Runs in a child until its line ends.
    using Serve = std::function<void(Connection&)>;
    ReaderProcesses(LineKind kind, size_t count, const Serve& serve);
    ~ReaderProcesses() override;

    // Sends messages with their length, for readObjects().
    void toAll(std::span<const std::byte> message) override;
    void toOne(objects::PeerId, std::span<const std::byte> message) override { toAll(message); }
    void send(std::span<const std::byte> bytes);
    // Waits for one acknowledgement of each process. Returns the number of good ones.
    size_t awaitAcknowledgements();

private:
    ChildProcesses children_;
    std::vector<std::unique_ptr<Connection>> lines_;
    std::vector<std::byte> framed_;
};

// Applies all messages. After a Commit, acknowledges the result of check(), which reads the newest state.
ReaderProcesses::Serve readObjects(std::function<bool(ObjectReader&)> check);
// Reads blocks of a fixed size, and acknowledges the result of check().
ReaderProcesses::Serve readBlocks(size_t sizeBytes, std::function<bool(std::span<const std::byte>)> check);

} // namespace mural::bench
