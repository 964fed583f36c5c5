// Random words and bytes with what goes wrong more often than by chance: extremes, runs, numbers that are equal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <hwy/targets.h>

namespace mural::compositor::test {

inline std::vector<std::byte> randomBytes(std::mt19937& random, size_t count) {
    std::vector<std::byte> bytes(count);
    for (auto& b : bytes) {
        const uint32_t kind = random() % 8;
        b = static_cast<std::byte>(kind == 0 ? 0 : kind == 1 ? 255 : random());
    }
    return bytes;
}

// Calls `each` once for every instruction set that this machine and this build have, with nothing better in use.
template <class Each> void forEachTarget(Each&& each) {
    for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
        const int64_t target = left & -left;
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        each(hwy::TargetName(target));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace mural::compositor::test
