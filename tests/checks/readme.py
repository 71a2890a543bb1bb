#!/usr/bin/env python3
"""readme.py SOURCE BINARY FOLDER: does what README.md says, in order, in a clone of SOURCE in FOLDER.

A fenced block is the file that the last name in backquotes before it says. An indented block is commands, run by bash; each must exit
with 0 and print nothing but notes on stderr. BINARY's folder stands in for build/release. `make` is left to .ci/run, which runs `make run` and
`make test`; commands that read scenes of others are left out, and named, where `make scenes-packages` has not been run.
"""
import os
import re
import shutil
import subprocess
import sys
import time

left_to_ci = {"make run", "make test", "make scenes-packages"}
scenes_of_others = ["/usr/share/sweethome3d", "/usr/share/games/openarena/baseoa"]
needs_scenes = re.compile(r"/usr/share/(sweethome3d|games)|out/apartment|out/shouse")


def blocks(lines):
    """('file', name, text) and ('command', line), in the order of the page."""
    name, fence, body = None, None, []
    for line in lines:
        if line.startswith("```"):
            if fence is None:
                fence, body = line, []
            else:
                yield ("file", name, "".join(text + "\n" for text in body))
                fence = name = None
        elif fence is not None:
            body.append(line)
        elif line.startswith("    "):
            yield ("command", line.strip())
        else:
            names = re.findall(r"`([\w.-]+\.\w+)`", line)
            name = names[-1] if names else name


def main():
    source, binary, folder = (os.path.abspath(word) for word in sys.argv[1:])
    shutil.rmtree(folder, ignore_errors=True)
    # Files as they are, committed or not: what is checked is this tree.
    listed = subprocess.run(["git", "-C", source, "ls-files", "-co", "--exclude-standard", "-z"], check=True, capture_output=True)
    for path in filter(None, listed.stdout.decode().split("\0")):
        if os.path.isfile(os.path.join(source, path)):
            os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
            shutil.copy2(os.path.join(source, path), os.path.join(folder, path))
    os.makedirs(os.path.join(folder, "build"))
    os.symlink(os.path.dirname(binary), os.path.join(folder, "build", "release"))

    with open(os.path.join(folder, "README.md"), encoding="utf-8") as page:
        steps = list(blocks(page.read().splitlines()))
    has_scenes = all(os.path.isdir(path) for path in scenes_of_others)
    environment, commands, left_out = dict(os.environ), 0, 0
    environment["PATH"] = "/usr/bin:" + environment["PATH"]  # Debian's Python, which has Debian's NumPy
    for step in steps:
        if step[0] == "file":
            if step[1] is None:
                sys.exit("README.md: a fenced block without the name of its file before it")
            with open(os.path.join(folder, step[1]), "w", encoding="utf-8") as out:
                out.write(step[2])
            print(f"wrote {step[1]}", flush=True)
            continue
        command = step[1]
        if re.sub(r"\s*#.*", "", command) in left_to_ci:
            continue
        if needs_scenes.search(command) and not has_scenes:
            left_out += 1
            print(f"LEFT OUT, no scenes of others installed: {command}", flush=True)
            continue
        assignment = re.fullmatch(r'PATH="\$PWD/(.*):\$PATH"', command)
        if assignment:
            environment["PATH"] = os.path.join(folder, assignment[1]) + ":" + environment["PATH"]
            continue
        start = time.monotonic()
        done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        print(f"{time.monotonic() - start:6.1f} s  {command}", flush=True)
        commands += 1
        complaints = [line for line in done.stderr.splitlines() if not line.startswith("note: ")]
        if done.returncode != 0 or complaints:
            sys.exit(f"README.md: exit code {done.returncode}: {command}\n{done.stderr}")
    if commands < 10:
        sys.exit(f"README.md: found {commands} commands, expected at least 10: has its form changed?")
    print(f"{commands} commands as README.md says" + (f", {left_out} left out" if left_out else ""))


main()
