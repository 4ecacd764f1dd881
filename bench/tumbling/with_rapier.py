"""Free tumbling in Rapier: runs the program whose path is the argument and evaluates its output."""
import subprocess
import sys

from score import STEPS, print_row, to_body

for precision in ("f64", "f32"):
    for dt in STEPS:
        out = subprocess.run([sys.argv[1], precision, str(dt)], capture_output=True, text=True, check=True)
        state = [float(value) for value in out.stdout.split()]
        q, omega = state[:4], state[4:]
        print_row("Rapier 0.36.1", f"its only one, {precision}", dt, q, to_body(q, omega))
