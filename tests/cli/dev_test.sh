#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# ./dev as a newcomer, CI and a machine without rights or network see it. A copy of it runs in an empty
# folder with stand-ins for apt-get, cmake and ctest that note how they were called.
set -euo pipefail
unset SK_PACKAGES   # the caller's own wish
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/repo" "$place/bin" "$place/elsewhere"
cp "$root/dev" "$root/packages.txt" "$root/CMakePresets.json" "$place/repo"
dev=$place/repo/dev
calls=$place/calls

# stand_in NAME BODY: a program that notes its arguments, then does BODY.
stand_in() {
  printf '#!/bin/bash\necho "%s $*" >>"%s"\n%s\n' "$1" "$calls" "$2" >"$place/bin/$1"
  chmod +x "$place/bin/$1"
}
# run STATUS ARGUMENT...: ./dev from another folder, without a terminal; its text goes to $said.
run() {
  local expected=$1 status=0
  shift
  : >"$calls"
  said=$(cd "$place/elsewhere" && PATH="$place/bin:$PATH" "$dev" "$@" 2>&1 </dev/null) || status=$?
  ((status == expected)) || broken "status $status of ./dev $*, not $expected"
  [[ $said != *$'\e'* ]] || broken "colours without a terminal"
}
broken() { printf 'broken: %s\nit said:\n%s\ncalls:\n%s\n' "$1" "$said" "$(cat "$calls")"; exit 1; }
says() { [[ $said == *"$1"* ]] || broken "it does not say: $1"; }
called() { grep -qxF -- "$1" "$calls" || broken "not called: $1"; }
never_called() { ! grep -q "^$1" "$calls" || broken "called: $1"; }

# dpkg_query STATUS NAME: a stand-in for dpkg-query that knows all of packages.txt, and NAME with that status.
dpkg_query() {
  printf 'awk -v status="%s" -v name="%s" %s "${0%%/*}/../repo/packages.txt"' "$1" "$2" \
    "'/^[a-z]/ { print \"installed=\" (\$1 == name ? status : \"installed\") \", \" \$1 \", \" }'"
}
all_installed=$(dpkg_query installed g++)
stand_in sudo 'while [[ $1 == -* ]]; do shift; done; exec "$@"'
stand_in apt-get ''
stand_in cmake ''
stand_in ctest 'echo "100% tests passed, 0 tests failed out of 1"; echo "PATH $PATH" >>"${0%/*}/../calls"'
stand_in python3 'mkdir -p "$3/build"'
stand_in dpkg-query "$all_installed"

# Help, and commands that do not exist.
run 0 help
for command in demo build test bench fuzz format lint install; do says "  $command"; done
run 0
says 'usage: ./dev COMMAND'
run 1 biuld
says "no command 'biuld'"
says 'usage: ./dev COMMAND'
run 1 build relaese
says "no preset 'relaese': release, debug, asan or tsan"
run 1 fuzz runtime
says 'fuzz what? mutate, kernels, cpp, numbers or parse_NAME'
run 1 fuzz parse_nothing
says 'fuzz what? mutate, kernels, cpp, numbers or parse_NAME'
never_called cmake

# All is installed: no apt-get; configure, build, test, whose closing line comes last.
run 0 test -R saxpy
never_called apt-get
called 'cmake --preset release'
called 'cmake --build --preset release -- --quiet'
called 'cmake --build --preset release --target web_tests -- --quiet'
called "ctest --preset release -j $(nproc) -C web -R saxpy"
[[ ${said##*$'\n'} == '100% tests passed, 0 tests failed out of 1' ]] || broken "the closing line is not ctest's"
run 0 test asan
called "ctest --preset asan -j $(nproc)"

# What is provided by an installed package is not installed again.
stand_in dpkg-query "$(dpkg_query not-installed npm); echo 'installed=installed, nodejs, nodejs-dev, npm (= 10.8)'"
run 0 test
never_called apt-get

# Tests see the programs of packages.txt alone, or all of this machine where these are not known.
called "python3 tests/cli/listed_programs.py . build/release/programs"
called "PATH $place/repo/build/release/programs/build"
stand_in python3 'echo "this is no Debian"; exit 77'
run 0 test
says 'tests may start any program of this machine: this is no Debian'
called "PATH $place/bin:$PATH"

# What was skipped is said last, with the reason, and the status is that of ctest.
mkdir -p "$place/log"
cat >"$place/log/LastTest.log" <<'END'
Start testing: Nov 28 15:27 UTC
----------------------------------------------------------
1/3 Testing: web.vite
1/3 Test: web.vite
Output:
----------------------------------------------------------
skipped: npm reaches no registry
<end of output>
Test time =   0.04 sec
----------------------------------------------------------
Test Skipped.
"web.vite" end time: Nov 28 15:27 UTC

2/3 Testing: web.calls
2/3 Test: web.calls
skipped: the package's size
<end of output>
Test Passed.

3/3 Testing: run.loops
3/3 Test: run.loops
<end of output>
Test Failed.
END
stand_in ctest 'mkdir -p build/release/Testing/Temporary; cp "${0%/*}/../log/LastTest.log" build/release/Testing/Temporary; exit 8'
run 8 test
says $'dev: not tested (2):\n  web.vite is skipped: npm reaches no registry\n  web.calls is skipped in part: the package\'s size'
[[ ${said##*$'\n'} == *"the package's size" ]] || broken "what was skipped is not said last"
stand_in ctest 'echo "100% tests passed, 0 tests failed out of 1"; echo "PATH $PATH" >>"${0%/*}/../calls"'

# Something is missing: only that is installed, and package lists are not fetched.
stand_in dpkg-query "$(dpkg_query not-installed cmake)"
run 0 build
says 'installing 1 Debian packages: cmake'
called 'apt-get -q -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 install --no-install-recommends cmake'
never_called 'apt-get .* update'

# What benchmarks alone want is installed for them alone, and CMake then looks for it; files are the caller's.
stand_in dpkg-query "$(dpkg_query not-installed libbenchmark-dev)"
mkdir -p "$place/repo/tests/bench"
printf '#!/bin/bash\necho "benchmarks of ${1##*/} in ${PWD##*/}: ${*:2}"\n' >"$place/repo/tests/bench/bench.sh"
chmod +x "$place/repo/tests/bench/bench.sh"
run 0 build
never_called apt-get
run 0 bench --json x.json
says 'installing 1 Debian packages: libbenchmark-dev'
called 'cmake --preset release'
called 'cmake --build --preset release --target tests/bench/all tests/bench/race/all -- --quiet'
says 'benchmarks of release in elsewhere: --json x.json'

# The browser is installed for the tests in it, which are left out where it cannot be.
no_chromium=$(dpkg_query not-installed chromium)
stand_in dpkg-query "$no_chromium"
stand_in apt-get 'exit 100'
run 0 test
says 'installing 1 Debian packages: chromium'
[[ ${said##*$'\n'} == '  the tests in browsers are left out: they need the packages [web] of packages.txt' ]] ||
  broken "the last line does not name what was left out"
called "ctest --preset release -j $(nproc)"
run 1 test web
run 0 test debug
never_called apt-get
stand_in apt-get 'touch "${0%/*}/../chromium"'
stand_in dpkg-query "[[ -e \${0%/*}/../chromium ]] && $all_installed && exit; $no_chromium"
run 0 test web -V
says 'installing 1 Debian packages: chromium'
called 'cmake --build --preset release --target web_tests -- --quiet'
called "ctest --preset release -j $(nproc) -C web -L ^web\$ -V"
run 0 test web all
never_called apt-get
called "ctest --preset release -j $(nproc) -C web_all -L ^web\$"
stand_in apt-get ''

# A bare machine has no package lists: they are fetched, then it is tried again.
stand_in apt-get 'case $* in *" update") touch "${0%/*}/../lists" ;; *) test -e "${0%/*}/../lists" ;; esac'
stand_in dpkg-query "$(dpkg_query not-installed cmake)"
run 0 build
called 'apt-get -q -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 update'

# No network.
stand_in apt-get 'echo "E: Could not resolve host"; exit 100'
run 1 build
says 'E: Could not resolve host'
says 'apt-get could not install them'
never_called cmake

# No right to install: what to install is said, and nothing is tried.
stand_in sudo 'exit 1'
as_nobody=()
((EUID != 0)) || as_nobody=(setpriv --reuid=65534 --clear-groups)
chmod -R a+rwX "$place"
: >"$calls"
if said=$(PATH="$place/bin:$PATH" "${as_nobody[@]}" "$dev" build 2>&1 </dev/null); then broken "it went on"; fi
says 'no right to install them; as root: apt-get install cmake'
never_called apt-get

# A system that is not Debian: on with what there is.
rm "$place/bin/dpkg-query"
mkdir "$place/plain"
for tool in bash env dirname readlink mkdir tail nproc cat grep; do ln -s "$(command -v $tool)" "$place/plain"; done
ln -s "$place/bin/cmake" "$place/bin/ctest" "$place/plain"
: >"$calls"
said=$(PATH=$place/plain "$dev" build 2>&1 </dev/null) || broken "it needs apt-get"
says 'no apt-get here: going on with what there is'
called 'cmake --preset release'

# A configuration that fails shows why.
stand_in dpkg-query "$all_installed"
stand_in cmake 'echo "no C++ compiler found"; exit 1'
run 1 build
says 'no C++ compiler found'
says 'cmake could not configure'

# packages.txt: every line says one package, under a section.
awk '/^#/ || !NF { next } /^\[(build|lint|bench|web|fuzz)\]$/ { section = 1; next }
     !section || !/^[a-z0-9][a-z0-9.+-]+( +#.*)?$/ { print "packages.txt:" NR ": " $0; bad = 1 }
     END { exit bad }' "$root/packages.txt"
echo "./dev does what ./dev help says"
