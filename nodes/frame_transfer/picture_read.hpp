// The readback of a drawn picture, used by the thread that encodes the picture.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

class PictureRead {
public:
    virtual ~PictureRead() = default;
    // Rows bottom first, B G R A, without padding; valid during this object's lifetime. Call once, from any thread.
    // Errors: the deadline has passed; the GL context is lost.
    [[nodiscard]] virtual Result<std::span<const std::byte>> bytes(Deadline deadline) = 0;
};

// A pool of picture buffers. Fresh memory from the system takes longer than reading into it.
class PictureMemory {
public:
    [[nodiscard]] std::vector<std::byte> take() {
        const std::lock_guard lock(mutex_);
        if (free_.empty()) return {};
        std::vector<std::byte> memory = std::move(free_.back());
        free_.pop_back();
        return memory;
    }
    void give(std::vector<std::byte> memory) {
        const std::lock_guard lock(mutex_);
        if (free_.size() < kMaxFree) free_.push_back(std::move(memory));
    }

private:
    static constexpr size_t kMaxFree = 3;
    std::mutex mutex_;
    std::vector<std::vector<std::byte>> free_;
};

// A picture that is already in memory.
class ReadPicture final : public PictureRead {
public:
    ReadPicture(std::vector<std::byte> bytes, std::shared_ptr<PictureMemory> memory)
        : bytes_(std::move(bytes)), memory_(std::move(memory)) {}
    ~ReadPicture() override {
        if (memory_) memory_->give(std::move(bytes_));
    }
    ReadPicture(const ReadPicture&) = delete;
    ReadPicture& operator=(const ReadPicture&) = delete;
    [[nodiscard]] Result<std::span<const std::byte>> bytes(Deadline) override {
        return std::span<const std::byte>(bytes_);
    }

private:
    std::vector<std::byte> bytes_;
    const std::shared_ptr<PictureMemory> memory_;
};

} // namespace mural
