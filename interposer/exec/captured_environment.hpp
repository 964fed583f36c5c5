// The environment of a program that this process executes. Adds LD_PRELOAD and the session if they are missing, because
// the new program would not be captured otherwise.
#pragma once

#include <cstddef>

namespace mural {

class CapturedEnvironment {
public:
    // environment: the new program's, terminated by null. A null pointer is an empty environment, as clearenv leaves
    // it. Nothing is allocated: the code runs between fork and exec. After vfork the memory is the parent's.
    explicit CapturedEnvironment(char* const* environment);

    // Returns the number of bytes that build() needs at `memory`, aligned as a pointer. 0: no change is needed.
    [[nodiscard]] size_t neededBytes() const { return neededBytes_; }
    [[nodiscard]] char* const* build(void* memory) const;

private:
    char* const* environment_;
    size_t count_ = 0;              // number of its entries
    const char* preload_ = nullptr; // its entry LD_PRELOAD
    size_t neededBytes_ = 0;
};

} // namespace mural
