// A client of PMIx, the service by which the processes of one mpirun or srun exchange data. The library is opened at
// run time, because most machines do not have it. No MPI is involved.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/launch/environment.hpp"

namespace mural::launch {

// The place of this process among the processes of one start, from the environment.
struct PmixPlace {
    int rank = 0;
    int size = 0; // number of processes; 0: unknown
};
// Returns rank -1 for a process that was not started with PMIx. Pure.
PmixPlace pmixPlaceOf(const Environment& environment);

// One per process and its life.
class PmixClient {
public:
    // Errors: libpmix.so.2 is not installed; no server has started this process.
    static Result<std::unique_ptr<PmixClient>> open();
    PmixClient(const PmixClient&) = delete;
    PmixClient& operator=(const PmixClient&) = delete;
    ~PmixClient();

    // Publishes a text for the other processes, from the next fence() on.
    [[nodiscard]] Result<void> put(const std::string& key, const std::string& text) const;
    // Waits until all processes call it. Polls `cancelled`, if any, and returns an error after it is true.
    [[nodiscard]] Result<void> fence(Deadline deadline, const std::function<bool()>& cancelled = {}) const;
    // Returns the text of another process.
    [[nodiscard]] Result<std::string> get(uint32_t rank, const std::string& key) const;

private:
    struct Library;
    explicit PmixClient(std::shared_ptr<Library> library);
    const std::shared_ptr<Library> library_; // also of a thread that waits in fence()
    mutable bool isInFence_ = false;         // after an abandoned fence: PMIx_Finalize would wait for the fence
};

} // namespace mural::launch
