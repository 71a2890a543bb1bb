#!/usr/bin/env python3
"""old_cpu.py BINARY: on a CPU that is no x86-64-v3, BINARY says so in one line and exits with 1.

The CPUs are models of qemu-x86_64. Exit code 77 when there is none.
"""
import shutil
import subprocess
import sys

qemu = shutil.which("qemu-x86_64")
if not qemu:
    print("SKIPPED: there is no qemu-x86_64 here (Debian package qemu-user)")
    sys.exit(77)
for cpu in "qemu64", "Nehalem", "SandyBridge":
    done = subprocess.run([qemu, "-cpu", cpu, sys.argv[1], "--version"], capture_output=True, text=True)
    lines = [line for line in done.stderr.splitlines() if not line.startswith("qemu-x86_64: warning:")]
    if done.returncode != 1 or done.stdout or len(lines) != 1 or "expected x86-64-v3" not in lines[0]:
        sys.exit(f"{cpu}: found exit code {done.returncode}, {done.stdout!r}, {done.stderr!r}, expected 1 and one line")
