// Index of objects by name, without hashing: names are allocated from 1 on, and most programs have few.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace mural::filter {

template <typename T> class NameIndex {
public:
    [[nodiscard]] T* find(uint32_t name) const {
        if (name < low_.size()) return low_[name];
        if (name < kLow) return nullptr;
        const auto found = high_.find(name);
        return found == high_.end() ? nullptr : found->second;
    }
    // null: removes the name.
    void set(uint32_t name, T* there) {
        if (name >= kLow) {
            if (there == nullptr)
                high_.erase(name);
            else
                high_[name] = there;
            return;
        }
        if (name >= low_.size()) low_.resize(name + size_t{1});
        low_[name] = there;
    }

private:
    static constexpr uint32_t kLow = 1 << 16;
    std::vector<T*> low_;
    std::unordered_map<uint32_t, T*> high_;
};

} // namespace mural::filter
