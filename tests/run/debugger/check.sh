#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# A debugger stops at a line of a .sk file, knows which kernel it is in and who called it, and shows variables of all kinds;
# profilers find the lines of addresses.
# Usage: check.sh PROGRAM
set -euo pipefail
program=$1
for tool in gdb nm addr2line; do
  command -v $tool >/dev/null || { echo "skipped: there is no $tool"; exit 77; }
done

# shows REGULAR-EXPRESSION: a line of what gdb has printed.
shows() { grep -qE -- "$1" <<<"$printed" || { printf 'broken: gdb does not show: %s\n%s\n' "$1" "$printed"; exit 1; }; }

printed=$(OMP_NUM_THREADS=1 gdb -nx -batch \
  -ex 'break heat.sk:21' -ex 'run' -ex 'backtrace' -ex 'info args' -ex 'info locals' -ex 'print hit.id' \
  -ex 'break heat.sk:6' -ex 'continue' -ex 'backtrace' -ex 'info locals' "$program" 2>&1)
shows '^21	  if \(isHot\) v = ramp\(v\);$'
shows '^#0 +heat \(k=0\.5, v=.*heat\.sk:21$'
shows '^#[1-9].* main \('
shows '^k = 0\.5$'                                   # uniform
shows '^v = \{10\.5, 8\.5, 12\.5, 10\.5\}$'          # one entry for each lane
shows '^i = 0$'                                      # the first lane's
shows '^isHot = \{true, false, true, false\}$'
shows '^pair = \{x = \{6, 4, 6, 4\}, y = 0\.5\}$'
shows '^table = \{\{6, 4, 6, 4\}, \{0\.5, 0\.5, 0\.5, 0\.5\}\}$'
shows '^hit = \{t = \{6, 4, 6, 4\}, id = 0\}$'
shows '^\$1 = 0$'
shows '^6	  return twice \+ 1;$'                    # in a function that the kernel calls
shows '^#1 .*heat \(.*heat\.sk:21$'
shows '^twice = \{21, 17, 25, 21\}$'

# A breakpoint on a kernel stops at its first statement, with its arguments; `next` goes through its lines once for all lanes.
printed=$(OMP_NUM_THREADS=1 gdb -nx -batch -ex 'break pick' -ex 'run' -ex 'info args' -ex 'next' -ex 'info locals' \
  -ex 'next' -ex 'next' -ex 'next' "$program" 2>&1)
shows '^x = \{1, 2, 3, 4\}$'
shows '^b = \{[0-9.]+, [0-9.]+, [0-9.]+, [0-9.]+\}$'
lines=$(sed -n 's/^\(2[0-9]\)\t.*/\1/p' <<<"$printed" | tr '\n' ' ')
[[ $lines == "25 26 27 29 " ]] || { printf 'broken: gdb stops at lines %s\n%s\n' "$lines" "$printed"; exit 1; }

address=$(nm "$program" | sed -n 's/^\([0-9a-f]*\) t .*_heat\.run.*$/\1/p' | head -n 1)
line=$(addr2line -e "$program" "$address")
[[ $line == */debugger/heat.sk:9 ]] || { echo "broken: addr2line has $line"; exit 1; }
echo "a debugger sees the kernel's lines and variables"
