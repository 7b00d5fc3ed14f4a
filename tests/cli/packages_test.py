# SPDX-License-Identifier: MIT
#
# packages_test.py SOURCE BUILD [WITHOUT]: what a bare Debian 12 would lack. Everything of the system that the build
# reads and that scripts, programs and tests start or load, also at run time, must belong to a package that [build] of
# packages.txt brings: one that it names, one that those depend on, or one that every Debian has. A machine where more
# is installed hides a package that is missing from the list; here dpkg says whose each file is, so that such a
# machine notices, too. WITHOUT is a package that packages.txt is to be read without.
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import debian
from debian import output

source, build = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
without = sys.argv[3:]
skipped = 77

# Programs that are started only where somebody has them, and why a test can do without.
optional = {
    "clang++-19": "[fuzz] has it, and only ./dev fuzz cpp starts it",
    "chromium": "[web] has it, and tests of programs for browsers are skipped without it",
    "ffmpeg": "writes films, which no test wants",
    "git": "fetches the sources, which are here",
    "node": "[web] has it, and tests of programs for browsers are skipped without it",
    "npm": "[web] has it, and tests of programs for browsers are skipped without it",
    "npx": "[web] has it, and tests of programs for browsers are skipped without it",
    "sudo": "installs packages, which are here",
    "tsc": "[web] has it, and tests of programs for browsers are skipped without it",
}


def skip(why):
    print(f"skipped: {why}")
    sys.exit(skipped)


# ---- what is used -----------------------------------------------------------------------------------------------


def is_measurement(file):
    """Benchmarks and ./dev itself may use what its other sections bring."""
    return file == "dev" or "tests/bench/" in file


def read_by_the_build():
    """Headers that compilers read, and what CMake found for our own CMakeLists.txt: (file, who wants it)."""
    wanted = ""
    headers = {}
    for line in output("ninja", "-C", build, "-t", "deps").splitlines():
        if not line.startswith(" "):
            wanted = line.partition(":")[0]
        elif not is_measurement(wanted):
            headers.setdefault(line, wanted)
    for header, wanted in headers.items():  # ccache may have made it relative to the build folder
        file = os.path.normpath(os.path.join(build, header.strip()))
        if not file.startswith((source, build)):
            yield file, wanted
    with open(os.path.join(build, "CMakeCache.txt")) as cache:
        for variable, file in re.findall(r"^(SK_\w+|PKG_CONFIG\w+):FILEPATH=(/.*)$", cache.read(), re.M):
            if os.path.basename(file) not in optional:
                yield file, variable


def binaries():
    """The programs and shared libraries that were built."""
    for folder, folders, names in os.walk(build):
        folders[:] = [name for name in folders if name != "CMakeFiles" and not name.startswith(".")]
        for name in names:
            file = os.path.join(folder, name)
            if os.access(file, os.X_OK) and not os.path.islink(file) and not is_measurement(file):
                with open(file, "rb") as start:
                    if start.read(4) == b"\x7fELF":
                        yield file


def linked():
    """Libraries that the loader finds for our programs: (file, who wants it)."""
    programs = list(binaries())
    for program in programs:
        for file in re.findall(r"(?:=> |^\t)(/\S+) \(0x", output("ldd", program), re.M):
            yield file, program


def loaded():
    """Libraries and drivers that an OpenGL and an OpenGL ES program load while they run: (file, who wants it)."""
    program = os.path.join(build, "runtime/tests/no_device_test")
    mesa = {
        "SK_DEVICE": "llvmpipe",
        "SK_CACHE": "off",
        "__EGL_VENDOR_LIBRARY_FILENAMES": "/usr/share/glvnd/egl_vendor.d/50_mesa.json",
    }
    for profile in ("glsl330", "essl300"):
        with tempfile.TemporaryDirectory() as folder:
            log = os.path.join(folder, "log")
            said = output(program, "opens", profile, **mesa, SK_PROFILE=profile, LD_DEBUG="files", LD_DEBUG_OUTPUT=log)
            if f", {profile}" not in said:
                sys.exit(f"no {profile} device was opened: {said}")
            for name in glob.glob(log + ".*"):
                with open(name) as lines:
                    for file in re.findall(r"calling init: (/\S+)", lines.read()):
                        yield file, f"the {profile} device"


start = r"(?:^|[|&;(`]|[!{]\s|\b(?:then|do|else|if|elif|while|until|exec|xargs|command -v|env|time)\s)\s*"
command_word = re.compile(start + r"(?:-\S+\s+|\d+\s+|[A-Z_]+=\S*\s+)*([a-z][a-z0-9.+_-]+)(?![\w=/(.:-])", re.M)
started_by_cpp = re.compile(r'\b(?:popen|system|runProgram|run)\(\s*\{?"([a-z][a-z0-9.+_-]*)[" ]')
started_by_python = re.compile(r'(?:run|which|output)\(\[?\s*"([a-z][a-z0-9.+_-]*)"')


here_document = re.compile(r"""(?<!<)(<<-?\s*(['"]?)(\w+)\2[^\n]*\n)(.*?)^\t*\3$""", re.S | re.M)


def without_texts(script):
    """A shell script without comments, here-documents and quoted text, but with the commands in quotes: "$(dirname x)"."""
    quoted = re.compile(r"""\\.|(?<!\S)\#[^\n]*|\$?'(?:[^'])*'|"(?:\\.|[^"\\])*\"""", re.S)

    def commands_in(text):
        return "".join(re.findall(r"\$\([^\s()]+", text))

    # a here-document first: it may have a single quote
    script = here_document.sub(lambda text: text[1] + ("" if text[2] else commands_in(text[4])), script)
    return quoted.sub(lambda text: commands_in(text[0]), script)


def scripts():
    """Texts that start programs: (file, text, how a program's name looks there)."""
    for folder in ("", ".ci", "compiler", "docs", "examples", "runtime", "tests"):
        for path, folders, names in os.walk(os.path.join(source, folder)):
            if not folder:
                folders.clear()
            for name in names:
                file = os.path.relpath(os.path.join(path, name), source)
                suffix = os.path.splitext(name)[1]
                if suffix not in (".sh", ".py", ".cpp", ".md") and file not in ("dev", ".ci/run"):
                    continue
                with open(os.path.join(source, file)) as opened:
                    text = opened.read()
                if suffix == ".md":
                    yield file, without_texts("\n".join(re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S))), command_word
                elif suffix in (".cpp", ".py"):
                    yield file, text, started_by_cpp if suffix == ".cpp" else started_by_python
                else:
                    yield file, without_texts(text), command_word


def started():
    """Programs of the system that scripts and programs name where a command stands: (file, who wants it)."""
    for file, text, pattern in scripts():
        for word in set(pattern.findall(text)) - optional.keys():
            program = shutil.which(word, path="/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin")
            if program:
                yield program, file


def python_modules():
    """Modules that our Python programs import, as Debian's own interpreter finds them: (file, who wants it)."""
    importers, ours = {}, set()
    for file, text, pattern in scripts():
        if pattern is started_by_python and not is_measurement(file):
            ours.add(os.path.splitext(os.path.basename(file))[0])
            importers.update((module, file) for module in re.findall(r"^\s*(?:import|from) (\w+)", text, re.M))
    find = "import importlib.util, sys\nfor m in sys.argv[1:]: print(m, getattr(importlib.util.find_spec(m), 'origin', 'missing'))"
    for line in output("/usr/bin/python3", "-I", "-c", find, *(importers.keys() - ours)).splitlines():
        module, origin = line.split(maxsplit=1)
        if origin == "missing":
            sys.exit(f"{importers[module]} imports {module}, which no package here has")
        if os.path.isabs(origin):
            yield origin, importers[module]


def shown_headers():
    """Headers of the system that the C++ of documents and of projects built by tests includes: (file, who wants it)."""
    folders = [place for form in ("/usr/include", "/usr/include/*-linux-gnu", "/usr/include/c++/*") for place in glob.glob(form)]
    for pattern in ("README.md", "docs/**/*.md", "examples/**/*.md", "tests/consumer/**/*.[ch]pp", "tests/cli/**/*.[ch]pp"):
        for file in glob.glob(os.path.join(source, pattern), recursive=True):
            with open(file) as text:
                for header in set(re.findall(r"^ *#include <([\w./+-]+)>", text.read(), re.M)):
                    yield from ((path, file) for folder in folders if os.path.exists(path := os.path.join(folder, header)))


# ---- the test ---------------------------------------------------------------------------------------------------

why = debian.why_unknown()
if why:
    skip(why)
installed = debian.Installed()
packages = debian.listed(source, without)
absent = [package for package in packages["build"] if package not in installed.depends]
if absent:
    skip(f"{' '.join(absent)} of packages.txt not installed, so that their dependencies are not known")

bare = installed.brought(packages["build"])
everything = installed.brought([package for section in packages.values() for package in section])
uses = {*read_by_the_build(), *linked(), *loaded(), *started(), *python_modules(), *shown_headers()}
owner = debian.owners({file for file, user in uses})
findings = {}  # one a file
for file, user in sorted(uses):
    may = everything if is_measurement(user) else bare
    if file in owner and owner[file] not in may:
        user = os.path.relpath(user, source) if user.startswith("/") else user
        findings[file] = f"{owner[file]} is not in packages.txt: {user} uses {file}"
for finding in findings.values():
    print(finding)
if findings:
    sys.exit(1)
print(f"{len(packages['build'])} packages bring the {len(owner)} files that are used")
