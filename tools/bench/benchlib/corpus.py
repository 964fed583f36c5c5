"""A corpus of public programs: a folder with corpus-run and apps.tsv. corpus-run starts a program with its
requirements (a display, a home folder, input). The program's clock advances only at swaps. corpus-run ends the
program after the last requested frame."""

import os

ENVIRONMENT = "MURAL_CORPUS"


class Program:
    def __init__(self, folder, which, columns):
        self.folder, self.which = folder, which
        self.name, self.frames, self.command = columns[0], [int(frame) for frame in columns[3].split(",")], columns[7]

    def words(self, out, frames, prefix=""):
        """Returns the command that runs the program and saves these frames as pictures in out/NAME; prefix: a
        launcher."""
        words = [os.path.join(self.folder, "corpus-run"), "--set", self.which, "--apps", self.name, "--out", out, "--frames", ",".join(map(str, frames))]
        return words + (["--prefix", prefix] if prefix else [])


def is_there(folder):
    return os.path.isfile(os.path.join(folder, "corpus-run"))


def programs(folder, which, names=None):
    """Returns the programs of a set, such as "public"; only those in `names`, if given."""
    found = []
    with open(os.path.join(folder, "apps.tsv"), encoding="utf-8") as file:
        for line in file:
            columns = line.rstrip("\n").split("\t")
            if line.startswith("#") or len(columns) < 8 or which not in columns[1].split(","):
                continue
            if not names or columns[0] in names:
                found.append(Program(folder, which, columns))
    return found
