"""Functions shared by the comparisons."""
import resource

import numpy as np

FAILURES = []  # messages, printed after the tables


def rotations(q):
    """Rotation matrices of quaternions (w, x, y, z) in the last axis; the matrices are in the last two axes."""
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def attempt(name, function):
    """Returns the result of `function`. If it fails, records the message and returns None."""
    try:
        return function()
    except Exception as error:  # any failure of one engine leaves the others in the comparison
        message = getattr(error, "stderr", None) or str(error)
        if isinstance(message, bytes):
            message = message.decode(errors="replace")
        lines = [line for line in message.splitlines() if line.strip()] or [repr(error)]
        FAILURES.append(f"{name}: {lines[0]}")
        return None


def processor_time():
    """Processor time (s) of this process and of the programs that it has run to the end."""
    usage = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(part.ru_utime + part.ru_stime for part in usage)


def print_table(headings, rows):
    """Prints a Markdown table."""
    for cells in (headings, ["---"] * len(headings), *rows):
        print("|", " | ".join(cells), "|", flush=True)
    print()


def three_digits(value):
    """Formats a number with three significant digits and without an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"
