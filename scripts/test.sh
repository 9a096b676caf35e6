#!/bin/sh
# Runs all tests: sh scripts/test.sh [what `cargo test` takes, such as --test gpu vectors_gpu]
#
# Many tests run on a GPU, and fail without one; a software Vulkan driver will do. Where there is none, and this script
# may (as root on Debian or Ubuntu), it installs one; elsewhere it says what to install.
#
# The window of `plumb preview` is tested on Xvfb, an X server without a screen (Linux only). The same goes for that.
#
# What `plumb slurm` writes is run by a real Slurm, which the tests start on this machine as root. Where this script may
# not install one, those tests are left out, and it says so.
#
# tests/gpu/drivers.rs compares the pictures of two drivers. The second one, SwiftShader, is taken out of a Debian
# package (32 MB, nothing is installed) and kept beside what is built. PLUMB_SECOND_DRIVER names the JSON file of
# another one.
set -eu
cd "$(dirname "$0")/.."

packages="mesa-vulkan-drivers libvulkan1"
# The server, and those of the libraries that a window loads when it opens that need not come with them.
window_packages="xvfb libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0"

# Slurm's daemons and commands, and what they sign their messages with.
slurm_packages="slurm-wlm munge"

say() { printf 'test.sh: %s\n' "$*"; }
stop() {
    printf 'test.sh: %s\n' "$*" >&2
    exit 1
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

# Mesa complains where it is not set.
if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR=$scratch/runtime
    mkdir -m 700 "$XDG_RUNTIME_DIR"
    export XDG_RUNTIME_DIR
fi

libraries() { (PATH=$PATH:/usr/sbin:/sbin && ldconfig -p 2>/dev/null); }

# Whether there is a file where the Vulkan loader looks for drivers, and the loader itself.
vulkan_seems_installed() {
    libraries | grep -q 'libvulkan\.so\.1' || return 1
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    for file in /usr/share/vulkan/icd.d/*.json /usr/local/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json; do
        [ ! -e "$file" ] || return 0
    done
    return 1
}

windows_seem_possible() {
    command -v Xvfb >/dev/null || return 1
    for library in libX11.so.6 libX11-xcb.so.1 libXcursor.so.1 libXi.so.6 libxkbcommon-x11.so.0; do
        libraries | grep -qF "$library " || return 1
    done
}

may_install() { [ "$(uname)" = Linux ] && [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }

# What is missing, then the packages that have it.
install() {
    say "$1: apt-get installs $2"
    # A package list that cannot be fetched need not matter: the installation tells.
    # shellcheck disable=SC2086
    { apt-get update || :; DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $2; } \
        </dev/null >"$scratch/apt-get" 2>&1 || {
        cat "$scratch/apt-get" >&2
        stop "apt-get could not install $2"
    }
}
installed=no
install_vulkan() {
    installed=yes
    install "no Vulkan driver found" "$packages"
}

command -v cargo >/dev/null || stop "there is no cargo: install Rust, see https://rustup.rs"
if may_install && ! vulkan_seems_installed; then
    install_vulkan
fi
if may_install && ! windows_seem_possible; then
    install "no Xvfb found, or not all libraries that a window loads" "$window_packages"
fi
if [ "$(uname)" = Linux ] && ! command -v Xvfb >/dev/null; then
    stop "there is no Xvfb, on which the window is tested (Debian, Ubuntu: apt-get install $window_packages; Fedora: dnf install xorg-x11-server-Xvfb libX11-xcb libXcursor libXi libxkbcommon-x11; Arch: pacman -S xorg-server-xvfb libxcursor libxi libxkbcommon-x11)"
fi

slurm_seems_installed() {
    (PATH=$PATH:/usr/sbin:/sbin && for name in sbatch slurmctld slurmd munged; do command -v "$name" || exit; done) >/dev/null
}
if [ -z "${PLUMB_WITHOUT_SLURM:-}" ]; then
    if may_install && ! slurm_seems_installed; then
        install "no Slurm found" "$slurm_packages"
    fi
    if [ "$(id -u)" != 0 ] || ! slurm_seems_installed; then
        PLUMB_WITHOUT_SLURM=1
        export PLUMB_WITHOUT_SLURM
        say "ATTENTION: WHAT plumb slurm WRITES IS NOT TESTED: that takes root and a Slurm (Debian, Ubuntu: apt-get install $slurm_packages)"
    fi
fi

# Several minutes the first time: someone who looks on sees what is compiled.
say "building"
if [ -t 2 ]; then quiet=; else quiet=--quiet; fi
cargo test --release --locked --features preview --no-run $quiet

# What plumb itself finds is what counts.
target=$(cargo metadata --locked --no-deps --format-version 1 | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
look() {
    # It says by its exit code, too, that there is none.
    "$target/release/plumb" doctor >"$scratch/doctor" 2>&1 || :
    found=$(sed -n 's/^plumb renders on \(.*\): .*/\1/p' "$scratch/doctor")
    if [ -z "$found" ]; then
        cat "$scratch/doctor" >&2
        stop "\`plumb doctor\` does not say what there is"
    fi
}
look
if [ "$found" = "the CPU" ] && [ "$installed" = no ] && may_install; then
    install_vulkan
    look
fi
if [ "$found" = "the CPU" ]; then
    stop "there is no GPU adapter: install your GPU's Vulkan driver, or the software one (Debian, Ubuntu: apt-get install $packages; Fedora: dnf install mesa-vulkan-drivers vulkan-loader; Arch: pacman -S vulkan-swrast)"
fi

# SwiftShader is made for browsers, and Debian has it in this package of one.
package=chromium-common
second=$target/second-driver
fetch_second() {
    say "fetching a second Vulkan driver: SwiftShader, out of Debian's $package"
    (
        mkdir "$scratch/deb" && cd "$scratch/deb" || exit
        # A package list may be missing, or too old to be true.
        apt-get download "$package" || { may_install && apt-get update && apt-get download "$package"; } || exit
        dpkg-deb --fsys-tarfile ./*.deb | tar -x ./usr/lib/chromium/libvk_swiftshader.so ./usr/lib/chromium/vk_swiftshader_icd.json || exit
        # Whole or not at all.
        rm -rf "$second" && mkdir "$second.new" && mv usr/lib/chromium/* "$second.new" && mv "$second.new" "$second"
    ) </dev/null >"$scratch/second" 2>&1
}
if [ -z "${PLUMB_SECOND_DRIVER:-}" ] && [ "$(uname)" = Linux ]; then
    if [ ! -e "$second/vk_swiftshader_icd.json" ]; then
        rm -rf "$second.new"
        if ! command -v apt-get >/dev/null || ! command -v dpkg-deb >/dev/null; then
            stop "there is no second Vulkan driver to compare with: name the JSON file of one in PLUMB_SECOND_DRIVER (SwiftShader's is vk_swiftshader_icd.json, in the folder of a Chromium)"
        fi
        fetch_second || {
            cat "$scratch/second" >&2
            stop "SwiftShader could not be fetched; name the JSON file of another Vulkan driver in PLUMB_SECOND_DRIVER"
        }
    fi
    PLUMB_SECOND_DRIVER=$second/vk_swiftshader_icd.json
    export PLUMB_SECOND_DRIVER
fi

say "testing on $found"
cargo test --release --locked --features preview --no-fail-fast --quiet "$@"
