# SPDX-License-Identifier: MIT
#
# The .sk files of this repository, for tests that show all of them to skc.
import os
import sys

# Options that the build gives to skc, too.
include_folders = ["compiler/native/library", "examples/applications/linear", "tests/run/shared"]

# Mistakes on purpose, and the library of native code.
left_out = ("tests/diagnostics/", "compiler/native/library/")


def options(source):
    return [f"-I{os.path.join(source, folder)}" for folder in include_folders]


def files(source, named):
    """The .sk files that are named, and those in the folders that are, relative to the folder `source`."""
    for name in named:
        path = os.path.join(source, name)
        if os.path.isfile(path):
            yield path
            continue
        if not os.path.isdir(path):
            sys.exit(f"there is no {path}")
        for folder, _, names in os.walk(path):
            for file in sorted(names):
                found = os.path.join(folder, file)
                if file.endswith(".sk") and not os.path.relpath(found, source).startswith(left_out):
                    yield found
