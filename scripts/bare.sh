#!/usr/bin/env bash
# Tries this repository as a new user would: makes a bare Debian 12 by debootstrap and runs commands in it, each in a fresh
# clone of HEAD, with times.
#   scripts/bare.sh                           the README's two commands: bash scripts/demo.sh, bash scripts/test.sh
#   scripts/bare.sh 'COMMAND' ...             these instead
# FOLDER (by default a new one under /var/tmp) is where the Debian is made; it goes at the end, unless KEEP is set.
# Takes over this machine's package sources and proxy settings. Needs root and debootstrap. Exits with 75 where it cannot
# work here, and else with the status of the first command that failed.
set -euo pipefail
cd "$(dirname "$0")/.."

cannot() {
    echo "bare.sh: $*" >&2
    exit 75
}

suite=bookworm
repository=$PWD
((EUID == 0)) || cannot "needs root"
[[ -d .git ]] || cannot "needs a repository, of which it makes clones"
command -v debootstrap >/dev/null || cannot "needs debootstrap"
unshare --mount true 2>/dev/null || cannot "no mounts of its own are allowed here"
mirror=$(apt-get indextargets --format '$(RELEASE) $(COMPONENT) $(REPO_URI)' 'Created-By: Packages' |
    awk -v suite="$suite" '$1 == suite && $2 == "main" { print $3; exit }')
[[ -n $mirror ]] || cannot "no package source of Debian $suite is set up, or apt-get update was never run"

root=${FOLDER:-$(mktemp -d /var/tmp/slabhull-bare-XXXXXX)}
chmod 755 "$root" 2>/dev/null || true # apt reads as another user
[[ -n ${KEEP:-} ]] || trap 'rm -rf --one-file-system "$root"' EXIT
commands=("$@")
((${#commands[@]})) || commands=("bash scripts/demo.sh" "bash scripts/test.sh")

seconds() { date +%s; }

make_debian() {
    local begin
    begin=$(seconds)
    mkdir -p "$root"
    debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" "$mirror" >"$root.log" 2>&1 ||
        { tail -5 "$root.log" >&2; rm -f "$root.log"; cannot "debootstrap failed"; }
    rm -f "$root.log" "$root/etc/apt/sources.list"
    cp -a /etc/apt/sources.list.d /etc/apt/apt.conf.d /etc/apt/trusted.gpg.d /etc/apt/keyrings "$root/etc/apt/" 2>/dev/null || true
    [[ ! -f /etc/apt/sources.list ]] || cp /etc/apt/sources.list "$root/etc/apt/"
    cp -a /usr/share/keyrings/. "$root/usr/share/keyrings/"
    cp -L /etc/hosts /etc/resolv.conf "$root/etc/" 2>/dev/null || true
    cp -a /etc/ssl/certs/. "$root/etc/ssl/certs/" 2>/dev/null || true # a proxy may have its own authority
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # it will not outlive a crash: no need to wait for the disk
    mkdir -p "$root/repository"
    echo "== a bare Debian $suite: $(($(seconds) - begin)) s"
}

# Runs a command in the Debian, with nothing of this environment but proxies and CI; its mounts go with it.
inside() {
    local kept=() name
    for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY CI; do
        [[ -z ${!name:-} ]] || kept+=("$name=${!name}")
    done
    unshare --mount --propagation private bash -euc '
        root=$1 repository=$2
        shift 2
        mount -t proc proc "$root/proc"
        mount --rbind /sys "$root/sys"
        mount --rbind /dev "$root/dev"
        mount --bind -o ro "$repository" "$root/repository"
        exec chroot "$root" "$@"' bare "$root" "$repository" \
        env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
        "${kept[@]}" bash -c "$1"
}

make_debian
# What a user has who clones: git.
inside 'apt-get update -qq && apt-get install -y -qq --no-install-recommends git >/dev/null 2>&1'
failed=0
for k in "${!commands[@]}"; do
    begin=$(seconds)
    echo "== ${commands[k]}"
    status=0
    inside "git config --global --add safe.directory /repository && git config --global --add safe.directory /repository/.git &&
        git clone -q /repository /root/clone$k && cd /root/clone$k && ${commands[k]}" || status=$?
    echo "== ${commands[k]}: exit $status, $(($(seconds) - begin)) s"
    ((failed)) || failed=$status
done
exit "$failed"
