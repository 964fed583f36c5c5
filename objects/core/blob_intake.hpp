// Blobs that a process receives: pushed ones, mapped ones, and those that it requests.
#pragma once

#include <deque>
#include <map>
#include <memory>

#include "objects/blob/blob_assembly.hpp"
#include "objects/blob/blob_store.hpp"
#include "objects/core/catalogue_writer.hpp"
#include "objects/core/link_rate.hpp"
#include "objects/core/message_sink.hpp"
#include "objects/core/object_state.hpp"

namespace mural::objects {

// The peer number of the writer in the sinks of readers.
constexpr PeerId kWriter = 0;

struct BlobIntakeOptions {
    uint64_t storeBytes = uint64_t{1} << 30;     // blobs that no state uses stay up to this sum
    uint64_t mostBlobBytes = uint64_t{64} << 30; // larger blobs are refused
    bool requestsPlaces = false;                 // the writer is a process of this machine, so its blobs can be mapped
    OpenOptions open;
};

// Requests go to the writer in pieces of kWindowBytes, so the reader bounds the bytes in transit. A request without a
// reply is repeated after kRetryNs.
class BlobIntake {
public:
    BlobIntake(MessageSink& sink, const BlobIntakeOptions& options)
        : sender_(sink), options_(options), store_(options.storeBytes) {}

    static constexpr uint32_t kWindowBytes = 2U << 20;
    static constexpr uint32_t kFirstWindowBytes = 2 * kBlobPieceBytes; // raw, until the rate of the connection is known
    static constexpr size_t kMaxRequests = 4;                          // at the same time
    static constexpr int64_t kRetryNs = 1'000'000'000;

    // Returns the entry for a reference. All states share it. If the blob is not here, request() it or wait for it.
    std::shared_ptr<BlobEntry> entryFor(const BlobRef& ref);
    void request(const std::shared_ptr<BlobEntry>& entry, int64_t nowNs);

    Result<void> input(const BlobBeginMessage& message);
    // Errors: a damaged piece, which is requested again.
    Result<void> input(const BlobDataMessage& message, int64_t nowNs);
    // Maps the blob. After a failure its bytes are requested when a state needs them, and mappingProblem() has the
    // reason.
    void input(const BlobAtMessage& message, int64_t nowNs);
    Result<void> input(const RefuseMessage& message, int64_t nowNs);
    // Pushed blobs stay at least until this call, after the commit that follows them.
    void releasePushed() { pushed_.clear(); }
    // Writes the pushed blobs whose commit has not arrived, complete or not, for a newcomer that receives that commit.
    void writePushed(BlobTransfer transfer, const MessageFunction& emit) const;
    // Repeats requests, and drops those that no state needs.
    void tick(int64_t nowNs);

    // Returns the reason why the last blob could not be mapped; empty: all were mapped.
    [[nodiscard]] const std::string& mappingProblem() const { return mappingProblem_; }
    [[nodiscard]] BlobStore& store() { return store_; }
    [[nodiscard]] size_t openRequests() const { return requests_.size() + queue_.size(); }

private:
    static constexpr size_t kMaxPushes = 4; // unfinished pushed blobs

    struct Request {
        std::weak_ptr<BlobEntry> entry;
        BlobAssembly assembly;
        uint64_t askedBytes = 0;
        bool takesPlace = false; // no place of the blob was invalid
        int64_t progressNs = 0;
        int64_t askedNs = 0;
    };
    // Returns the stored blob; it stays in the store as long as a copy exists.
    Blob arrived(const Blob& blob);
    void startRequests(int64_t nowNs);
    void ask(const BlobName& name, Request& request, int64_t nowNs);

    MessageSender sender_;
    BlobIntakeOptions options_;
    BlobStore store_;
    std::map<BlobName, std::weak_ptr<BlobEntry>> entries_; // of living states
    size_t sweepAt_ = 64;                                  // number of entries at which expired ones are removed
    std::map<BlobName, Request> requests_;
    std::deque<std::shared_ptr<BlobEntry>> queue_; // requests that wait for their turn
    std::deque<std::pair<BlobName, BlobAssembly>> pushes_;
    std::vector<std::byte> decoded_; // scratch memory
    LinkRate rate_;                  // of the connection from the writer
    std::string mappingProblem_;
    std::vector<Blob> pushed_; // complete, until a commit refers to them
};

} // namespace mural::objects
