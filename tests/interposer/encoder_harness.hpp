// Runs the interposer's encoder on a buffer of the test instead of the head's chunks. The output is kept in the order
// of publication, in which the head forwards it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "interposer/context/context.hpp"
#include "interposer/encode/encode_support.hpp"

namespace mural::testing {

class EncoderHarness {
public:
    EncoderHarness();
    ~EncoderHarness();
    EncoderHarness(const EncoderHarness&) = delete;
    EncoderHarness& operator=(const EncoderHarness&) = delete;

    ThreadState& thread() { return thread_; }
    // Returns the payloads of packets encoded since the last call, one piece per chunk.
    std::vector<std::vector<std::byte>> takePackets();
    // Returns the same in one piece.
    std::vector<std::byte> takeBytes();
    // Simulates the end of the head.
    void loseHead();
    // Sets whether the encoding context has an unpack buffer bound.
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
