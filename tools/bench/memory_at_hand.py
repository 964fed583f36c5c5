"""Memory that the system has at hand before something is timed.

Where a hypervisor takes free memory away, the first use of each MiB takes milliseconds until it is back: that is nobody's work.
"""

import mmap

PAGE_BYTES = 4096


def have(mib):
    """Uses so many MiB once and frees them; no more than half of what is available."""
    size = min(mib << 20, available_bytes() // 2) // PAGE_BYTES * PAGE_BYTES
    if size == 0:
        return
    with mmap.mmap(-1, size) as memory:
        memory.madvise(mmap.MADV_HUGEPAGE)
        for at in range(0, size, PAGE_BYTES):
            memory[at] = 1


def available_bytes():
    with open("/proc/meminfo", encoding="ascii") as file:
        for line in file:
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) << 10
    return 0
