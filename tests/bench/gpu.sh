#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# gpu.sh FOLDER OUT [ARGUMENTS of sk_race]: the benchmarks on a machine with a GPU, from what pack.sh has packed. Peers
# in CUDA and with OpenMP are compiled there if it has the compilers, PyTorch takes part if it is installed. Everything goes
# to OUT: race.json, torch.json, both as one in all.json, and what was printed.
set -euo pipefail
folder=$(readlink -f "${1:?usage: gpu.sh FOLDER OUT [ARGUMENTS of sk_race]}")
out=${2:?usage: gpu.sh FOLDER OUT [ARGUMENTS of sk_race]}
shift 2
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
mkdir -p "$out"
export LD_LIBRARY_PATH=$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}

# compiled NAME COMMAND...: a peer, or why there is none.
compiled() {
  local name=$1
  shift
  if ! command -v "$1" >/dev/null; then
    echo "gpu.sh: no $1, so $name stays as it is"
  elif ! "$@" -o "$folder/$name.new" >"$out/$name.log" 2>&1; then
    echo "gpu.sh: $name could not be compiled:" && head -n 20 "$out/$name.log"
  else
    mv "$folder/$name.new" "$folder/$name"
  fi
}
race=$here/race
compiled peer_openmp.so g++ -std=c++20 -O3 -march=native -fopenmp -shared -fPIC "-I$race" "$race"/peers/openmp/*.cpp
PATH=$PATH:/usr/local/cuda/bin compiled peer_cuda.so nvcc -std=c++17 -O3 -arch=native -shared -Xcompiler -fPIC \
  "-I$race" "$race/peers/cuda/peers.cu"

status=0
"$folder/sk_race" --json "$out/race.json" "$@" 2>&1 | tee "$out/race.txt" || status=$?
files=("$out/race.json")
if python3 -c 'import torch' 2>/dev/null; then
  python3 -B "$here/torch_peer.py" --json "$out/torch.json" 2>&1 | tee "$out/torch.txt" || status=$?
  files+=("$out/torch.json")
else
  echo "gpu.sh: no PyTorch"
fi
python3 -B "$here/report.py" "${files[@]}" --json "$out/all.json" | tee "$out/tables.txt"
exit "$status"
