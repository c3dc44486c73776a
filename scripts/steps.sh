# Sourced by ./setup, ./test and the scripts beside it: numbered steps that stop at the first failure with one clear
# line, the apt packages, and the configured build.
set -Eeuo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
export LC_ALL=C.UTF-8 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MPLBACKEND=Agg

current_step="starting"
step_number=0
trap 'status=$?; printf "\n%s stopped: %s failed (exit status %s).\n" "$(basename "$0")" "$current_step" "$status" >&2; exit "$status"' ERR

# step "what it does": names what runs from here on; the name appears in the message if it fails.
step() {
  step_number=$((step_number + 1))
  current_step="step $step_number, $1"
  printf '\n== %s. %s\n' "$step_number" "$1"
}

# stop "message": ends with that line and status 1.
stop() {
  printf '\n%s stopped: %s\n' "$(basename "$0")" "$1" >&2
  exit 1
}

# Compilers at work at a time: one per core, and at least 1.5 GB of memory for each.
compilers() {
  local cores memory
  cores=$(env -u OMP_NUM_THREADS nproc)  # or it would answer with the threads of a program, one
  memory=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo 2>/dev/null || true)
  if [ -n "$memory" ] && [ "$memory" -lt "$cores" ]; then cores=$memory; fi
  if [ "$cores" -lt 1 ]; then cores=1; fi
  echo "$cores"
}

# install_packages FILE...: installs the packages listed in the files; asks apt only if one is missing.
install_packages() {
  local wanted missing=() package sudo=()
  wanted=$(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$@")
  command -v dpkg-query >/dev/null || stop "this is no Debian system; install the packages named in $* by your own means, then build as docs/how-to/build-by-hand.md says."
  for package in $wanted; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  if [ "${#missing[@]}" -eq 0 ]; then
    echo "all $(wc -w <<<"$wanted") packages are there"
    return
  fi
  echo "missing: ${missing[*]}"
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || stop "these packages need root and there is no sudo; as root run: apt-get install --no-install-recommends ${missing[*]}"
    sudo=(sudo)
    [ -t 0 ] || sudo=(sudo -n)  # nobody there to type a password
    sudo+=(env)
  else
    sudo=(env)
  fi
  "${sudo[@]}" DEBIAN_FRONTEND=noninteractive apt-get -q update
  "${sudo[@]}" DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0 install --no-install-recommends "${missing[@]}"
}

# configure DIRECTORY [option...]: CMake with Ninja, and ccache if it is installed, otherwise precompiled headers: they
# save a third of an optimised build from nothing, and ccache cannot store what was compiled with them.
configure() {
  local directory=$1 launcher=(-DWISP_PRECOMPILE=ON)
  shift
  if command -v ccache >/dev/null; then
    launcher=(-DWISP_PRECOMPILE=OFF -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  cmake -S . -B "$directory" -G Ninja "${launcher[@]}" "$@"
}
