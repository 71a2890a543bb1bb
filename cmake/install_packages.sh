#!/bin/sh
# install_packages.sh LIST...: installs the Debian packages of the lists that are missing; silent when none is.
set -eu
list=$(sed -e 's/#.*//' "$@" | sort -u)
missing=""
for package in $list; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "install_packages: need root or sudo to install:$missing" >&2; exit 1; }
    as_root=sudo
fi
echo "installing:$missing"
$as_root apt-get update
# shellcheck disable=SC2086 # word splitting is meant: one word a package
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
