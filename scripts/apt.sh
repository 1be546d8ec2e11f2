# Sourced by the scripts that install Debian packages when they run as root.

say() { echo "hilbed: $*" >&2; }

can_install() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }

# One at a time; what apt-get says is shown only where it fails.
apt_install() {
    local log status=0
    log=$(mktemp)
    say "apt-get install $*"
    {
        command -v flock >/dev/null && flock 9
        apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
    } 9</var/lib/apt >"$log" 2>&1 </dev/null || status=$?
    [ "$status" = 0 ] || cat "$log" >&2
    rm -f "$log"
    return "$status"
}
