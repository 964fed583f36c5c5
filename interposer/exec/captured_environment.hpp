// The environment of a program that this process executes. LD_PRELOAD and the session are added where they are missing:
// without them the new program would not be captured.
#pragma once

#include <cstddef>

namespace mural {

class CapturedEnvironment {
public:
    // environment: of the new program, ended by null; null itself is an empty one, as clearenv leaves it. Nothing is allocated: these run between fork and
    // exec, of vfork too, where the memory is the parent's.
    explicit CapturedEnvironment(char* const* environment);

    // Bytes that build() needs at `memory`, aligned as a pointer; 0: the environment stays as it is.
    [[nodiscard]] size_t neededBytes() const { return neededBytes_; }
    [[nodiscard]] char* const* build(void* memory) const;

private:
    char* const* environment_;
    size_t count_ = 0;              // of its entries
    const char* preload_ = nullptr; // its entry LD_PRELOAD
    size_t neededBytes_ = 0;
};

} // namespace mural
