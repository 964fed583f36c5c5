// Runs tests of Highway kernels with each instruction set of the build.
#pragma once

#include <cstdint>

#include <hwy/targets.h>

namespace mural::test {

// Calls `each` once for every instruction set of this machine and build, with all better ones disabled.
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

} // namespace mural::test
