# SPDX-License-Identifier: MIT
#
# listed_programs.py SOURCE FOLDER: links in FOLDER/build to the programs that a bare Debian 12 has with the packages [build] of
# packages.txt, and in FOLDER/web to those that [web] adds. ./dev test runs the tests with these folders as their PATH, so that a test
# that starts another program, whether it is written in C++, in a script or in a document, fails on every machine. Prints why and exits
# with 77 where the system is another.
import os
import shutil
import sys

import debian

source, folder = sys.argv[1:3]
places = ("/usr/bin", "/usr/sbin")  # /bin and /sbin are the same folders


def programs(packages):
    """Name: path of what these packages have in a PATH, also as an alternative (update-alternatives)."""
    own = set(debian.files(packages))
    for place in places:
        for entry in os.scandir(place):
            spellings = [entry.path, entry.path.removeprefix("/usr"), "/usr" + entry.path]
            if os.path.islink(entry.path) and os.readlink(entry.path).startswith("/etc/alternatives/"):
                target = os.path.realpath(entry.path)
                spellings = [target, target.removeprefix("/usr")]
            if own.intersection(spellings):
                yield entry.name, entry.path


why = debian.why_unknown()
if why:
    print(why)
    sys.exit(77)
listed = debian.listed(source)
installed = debian.Installed()
build = installed.brought(listed["build"])
web = installed.brought([*listed["build"], *listed["web"]]) - build
for name, packages in (("build", build), ("web", web)):
    place = os.path.join(folder, name)
    shutil.rmtree(place, ignore_errors=True)
    os.makedirs(place)
    for program, path in dict(programs(packages)).items():
        os.symlink(path, os.path.join(place, program))
