"""Free tumbling in Rapier: runs the program whose path is given and scores what it prints."""
import subprocess
import sys

from score import STEPS, row, to_body

for precision in ("f64", "f32"):
    for dt in STEPS:
        out = subprocess.run([sys.argv[1], precision, str(dt)], capture_output=True, text=True, check=True)
        state = [float(word) for word in out.stdout.split()]
        q, omega = state[:4], state[4:]
        row("Rapier 0.36.1", f"its only one, {precision}", dt, q, to_body(q, omega))
