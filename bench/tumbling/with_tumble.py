"""Free tumbling in tumble, whose command is given.

`splitting`: the figures of `tumble verify tumbling`, which has the moments exact.
`euler`: the scene beside this file, six particles whose moments are (1, 2, 3) to rounding.
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

from score import STEPS, line, row, to_body

tumble = sys.argv[1]
version = subprocess.run([tumble, "--version"], capture_output=True, text=True, check=True)
engine = f"tumble {version.stdout.split()[-1]}"

out = subprocess.run([tumble, "verify", "tumbling"], capture_output=True, text=True, check=True)
found = {}
for text in out.stdout.splitlines():
    # what, dt = … s   expected   measured   ±bound   verdict
    words = re.split(r"\s{2,}", text.strip())
    what = re.fullmatch(r"(orientation|energy, relative|\|L\|, relative), dt = (\S+) s", words[0])
    if what:
        found[what[1], float(what[2])] = float(words[2].split()[0])
for dt in STEPS:
    energy, momentum = found["energy, relative", dt], found["|L|, relative", dt]
    print(line(engine, "splitting", dt, energy, momentum, found["orientation", dt]))

scene = pathlib.Path(__file__).with_name("tumbling.toml")
for dt in STEPS:
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder, "run")
        command = [tumble, "run", str(scene), "--set", f"dt={dt}", "--out", str(run)]
        subprocess.run(command, capture_output=True, check=True)
        last = list(csv.DictReader(run.joinpath("trajectory.csv").open()))[-1]
    q = [float(last[key]) for key in ("qw", "qx", "qy", "qz")]
    omega = [float(last[key]) for key in ("wx", "wy", "wz")]
    row(engine, "euler", dt, q, to_body(q, omega))
