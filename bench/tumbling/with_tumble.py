"""Free tumbling in tumble; the argument is the path of the command.

`splitting`: the values of `tumble verify tumbling`, which uses the exact moments.
`euler`: the scene tumbling.toml, six particles with moments (1, 2, 3) up to rounding.
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

from score import STEPS, format_row, print_row, to_body

tumble = sys.argv[1]
version = subprocess.run([tumble, "--version"], capture_output=True, text=True, check=True)
engine = f"tumble {version.stdout.split()[-1]}"

out = subprocess.run([tumble, "verify", "tumbling"], capture_output=True, text=True, check=True)
measured = {}
for text in out.stdout.splitlines():
    # quantity, dt = … s   expected   measured   ±bound   verdict
    columns = re.split(r"\s{2,}", text.strip())
    match = re.fullmatch(r"(orientation|energy, relative|\|L\|, relative), dt = (\S+) s", columns[0])
    if match:
        measured[match[1], float(match[2])] = float(columns[2].split()[0])
for dt in STEPS:
    energy, momentum = measured["energy, relative", dt], measured["|L|, relative", dt]
    print(format_row(engine, "splitting", dt, energy, momentum, measured["orientation", dt]))

scene = pathlib.Path(__file__).with_name("tumbling.toml")
for dt in STEPS:
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder, "run")
        command = [tumble, "run", str(scene), "--set", f"dt={dt}", "--out", str(run)]
        subprocess.run(command, capture_output=True, check=True)
        last = list(csv.DictReader(run.joinpath("trajectory.csv").open()))[-1]
    q = [float(last[key]) for key in ("qw", "qx", "qy", "qz")]
    omega = [float(last[key]) for key in ("wx", "wy", "wz")]
    print_row(engine, "euler", dt, q, to_body(q, omega))
