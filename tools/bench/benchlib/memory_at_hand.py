"""Requests memory from the system before a measurement.

A hypervisor may have reclaimed free memory. The first use of each MiB then takes milliseconds, which must not count
in the measurement.
"""

import mmap

PAGE_BYTES = 4096


def have(mib):
    """Uses that number of MiB once and frees it; at most half of the available memory."""
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
