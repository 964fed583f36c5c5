// The interposer's encoder over a buffer of the test's own instead of a head's chunks: what it writes is
// kept in the order of publication, as the head would forward it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "interposer/context.hpp"
#include "interposer/encode_support.hpp"

namespace mural::testing {

class EncoderHarness {
public:
    EncoderHarness();
    ~EncoderHarness();
    EncoderHarness(const EncoderHarness&) = delete;
    EncoderHarness& operator=(const EncoderHarness&) = delete;

    ThreadState& thread() { return thread_; }
    // All that was encoded since the last call, one piece per chunk: the payloads of packets.
    std::vector<std::vector<std::byte>> takePackets();
    // The same in one piece.
    std::vector<std::byte> takeBytes();
    // As if the head had gone.
    void loseHead();
    // The context that encodes has an unpack buffer bound.
    void bindUnpackBuffer(bool bound);
    size_t chunksTaken() const { return chunksTaken_; }

    // ---- for the session that stands in (encoder_harness.cpp)
    void publish(ThreadState& t);
    bool takeChunk(ThreadState& t);
    bool alive() const { return alive_; }
    bool unpackBuffer() const { return unpackBuffer_; }

private:
    std::unique_ptr<std::byte[]> chunk_;
    std::vector<std::vector<std::byte>> published_;
    size_t chunksTaken_ = 0;
    bool alive_ = true, unpackBuffer_ = false;
    ShareGroup group_;
    Context context_;
    ThreadState thread_;
};

} // namespace mural::testing
