"""Builds icet_kernels.c and icet_ranks.c against the sources of IceT, outside of the tree."""

import glob
import os
import re
import subprocess

# Values that IceT's own CMake detects on 64-bit Linux. Everything else that it may define is left out.
VALUES = {"ICET_MAJOR_VERSION": "2", "ICET_MINOR_VERSION": "2", "ICET_PATCH_VERSION": "0", "ICET_VERSION": "2.2.0",
          "ICET_SIZEOF_CHAR": "1", "ICET_SIZEOF_SHORT": "2", "ICET_SIZEOF_INT": "4", "ICET_SIZEOF_LONG": "8", "ICET_SIZEOF_LONG_LONG": "8",
          "ICET_SIZEOF_FLOAT": "4", "ICET_SIZEOF_DOUBLE": "8", "ICET_SIZEOF_VOID_P": "8", "ICET_MAGIC_K": "8", "ICET_MAX_IMAGE_SPLIT": "512"}


class BuildFailed(Exception):
    pass


def sources_of(folder):
    """Returns the folder that contains src/ice-t, in or below `folder` (as in ParaView's source package)."""
    for root, names, _ in os.walk(folder):
        if os.path.isfile(os.path.join(root, "src", "ice-t", "image.c")):
            return root
        names[:] = [n for n in names if not n.startswith(".")]
    raise BuildFailed("%s holds no src/ice-t/image.c; give the sources of IceT, as in Debian's: apt-get source paraview" % folder)


def configured(template):
    """Returns the text of IceTConfig.h.in with VALUES substituted as by CMake."""
    def define(match):
        return "#define %s %s" % (match.group(1), VALUES[match.group(1)]) if match.group(1) in VALUES else "/* no %s */" % match.group(1)
    text = re.sub(r"^#cmakedefine[ \t]+(\w+).*$", define, template, flags=re.M)
    return re.sub(r"@(\w+)@", lambda match: VALUES.get(match.group(1), "0"), text)


def build(folder, bench_folder, into):
    """Builds the shared library in the folder `into`. Returns its path."""
    icet = sources_of(os.path.abspath(folder))
    with open(os.path.join(icet, "src", "include", "IceTConfig.h.in"), encoding="utf-8") as file:
        config = configured(file.read())
    with open(os.path.join(into, "IceTConfig.h"), "w", encoding="utf-8") as file:
        file.write(config)
    library = os.path.join(into, "libicet_kernels.so")
    # IceT's strategies include MPI's header, and use nothing of it.
    with open(os.path.join(into, "mpi.h"), "w", encoding="utf-8"):
        pass
    sources = sorted(glob.glob(os.path.join(icet, "src", "ice-t", "*.c")) + glob.glob(os.path.join(icet, "src", "strategies", "*.c")))
    command = ["cc", "-O2", "-w", "-shared", "-fPIC", "-fvisibility=hidden", "-I", os.path.dirname(os.path.dirname(bench_folder)), "-I", into, "-I", os.path.join(icet, "src", "include"), "-o", library,
               os.path.join(bench_folder, "icet_kernels.c"), os.path.join(bench_folder, "icet_ranks.c")] + sources + ["-lm"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise BuildFailed("IceT in %s cannot be built: %s" % (icet, next((line for line in done.stderr.splitlines() if "error" in line), done.stderr.strip()[:300])))
    return library
