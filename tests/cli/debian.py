# SPDX-License-Identifier: MIT
#
# What packages.txt brings to a Debian 12 that has nothing else, as dpkg knows it. On a machine where more is installed, this tells
# the programs and libraries that a bare machine has from those that it lacks.
import collections
import glob
import os
import re
import shutil
import subprocess


def output(*command, **environment):
    """What a command prints; its failure is for the caller to see in that."""
    return subprocess.run(
        command, capture_output=True, text=True, errors="replace", env={**os.environ, "LC_ALL": "C", **environment}
    ).stdout


def listed(source, without=()):
    """The packages of packages.txt in the folder `source`, by section; `without` are left out."""
    packages = collections.defaultdict(list)
    section = ""
    with open(os.path.join(source, "packages.txt")) as lines:
        for line in lines:
            line = line.partition("#")[0].strip()
            if line.startswith("["):
                section = line.strip("[]")
            elif line and line not in without:
                packages[section].append(line)
    return packages


class Installed:
    """What dpkg knows of the packages on this machine."""

    def __init__(self):
        self.depends = {}
        self.present = set()  # what a Debian without anything has: debootstrap --variant=minbase
        self.providers = collections.defaultdict(list)
        form = r"${db:Status-Status}\t${Package}\t${Essential}\t${Priority}\t${Provides}\t${Pre-Depends}, ${Depends}\n"
        for line in output("dpkg-query", "-W", "-f", form).splitlines():
            status, package, essential, priority, provides, depends = line.split("\t")
            if status != "installed":
                continue
            self.depends[package] = [self.names(group, "|") for group in depends.split(",")]
            for name in self.names(provides, ","):
                self.providers[name].append(package)
            if essential == "yes" or priority == "required" or package == "apt":
                self.present.add(package)

    @staticmethod
    def names(text, separator):
        """`libc6 (>= 2.34) | libc6:any` without versions and architectures."""
        return [re.split("[ (:]", part.strip())[0] for part in text.split(separator) if part.strip()]

    def brought(self, packages):
        """These packages and all that they depend on. Of alternatives apt takes the first unless another comes anyway,
        so that they wait until nothing else does."""
        found = set()
        waiting = [*self.present, *packages]
        choices = []
        while waiting or choices:
            if not waiting:
                choice = choices.pop(0)
                waiting = [] if found.intersection(choice) else choice[:1]
                continue
            package = waiting.pop()
            if package in found:
                continue
            found.add(package)
            for alternatives in self.depends.get(package, ()):
                candidates = [one for name in alternatives for one in [name, *self.providers[name]]]
                candidates = [one for one in candidates if one in self.depends]
                if len(candidates) == 1:
                    waiting += candidates
                else:
                    choices.append(candidates)
        return found


def owners(files):
    """File: its package. A file of no package, such as one of our own or of a driver's installer, is left out."""
    spellings = collections.defaultdict(set)  # as dpkg may know it: file
    for file in files:
        for name in (os.path.normpath(file), os.path.realpath(file)):
            spellings[name].add(file)
            merged = re.match("(/usr)?(/(?:bin|sbin|lib|lib32|lib64|libx32)/.*)", name)
            if merged:  # /lib is /usr/lib, and packages say either
                spellings[merged[2]].add(file)
                spellings["/usr" + merged[2]].add(file)
    found = {}
    for line in output("dpkg-query", "-S", *spellings).splitlines():
        package, _, name = line.partition(": ")
        if not package.startswith("diversion "):
            for file in spellings.get(name, ()):
                found.setdefault(file, re.split("[:,]", package)[0])
    return found


def files(packages):
    """The files of installed packages."""
    for package in packages:
        for name in glob.glob(f"/var/lib/dpkg/info/{package}.list") + glob.glob(f"/var/lib/dpkg/info/{package}:*.list"):
            with open(name) as lines:
                yield from lines.read().splitlines()


def why_unknown():
    """Why this machine cannot tell what packages.txt brings; None where it can."""
    if not shutil.which("dpkg-query"):
        return "this is no Debian; packages.txt is about Debian 12"
    with open("/etc/os-release") as release:
        if not re.search('^VERSION_ID="?12"?$', release.read(), re.M):
            return "this is no Debian 12, which packages.txt is about"
    return None
