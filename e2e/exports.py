"""Reads what `tumble export` wrote with USD, VTK and ffmpeg, and holds it against trajectory.csv.

Call: exports.py FOLDER NAME, for the run FOLDER/NAME and the exports FOLDER/NAME.*
"""

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyvista
from pxr import Usd, UsdGeom, UsdValidation

folder, name = Path(sys.argv[1]), sys.argv[2]

with open(folder / name / "trajectory.csv", newline="", encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
bodies = list(dict.fromkeys(row["body"] for row in rows))
times = sorted({float(row["time"]) for row in rows})
last = {row["body"]: row for row in rows[-len(bodies):]}


def numbers(row, keys):
    return np.array([float(row[key]) for key in keys])


def check(held, what):
    if not held:
        sys.exit(f"{name}: {what}")


def usd():
    stage = Usd.Stage.Open(str(folder / f"{name}.usda"))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    problems = UsdValidation.ValidationContext(validators).Validate(stage)
    check(not problems, [problem.GetErrorAsString() for problem in problems])
    rate = stage.GetTimeCodesPerSecond()
    check(stage.GetDefaultPrim().GetPath() == "/World", "no default prim")
    check(UsdGeom.GetStageMetersPerUnit(stage) == 1, "not in metres")
    check(np.isclose(stage.GetEndTimeCode(), times[-1] * rate), "another end")
    check(UsdGeom.GetStageUpAxis(stage) == ("Z" if name == "points" else "Y"), "another way up")
    moved = [prim for prim in stage.GetDefaultPrim().GetChildren() if prim.GetDisplayName() in bodies]
    check([prim.GetDisplayName() for prim in moved] == bodies, "other bodies")
    drawn = [prim for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies())
             if prim.IsA(UsdGeom.Gprim)]
    check(len(drawn) >= len(bodies), "shapes are missing")
    for prim in moved:
        turn = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(stage.GetEndTimeCode())
        row = last[prim.GetDisplayName()]
        check(np.allclose(turn.ExtractTranslation(), numbers(row, ["px", "py", "pz"])), "another place")
        q = turn.ExtractRotationQuat()
        q = np.array([q.GetReal(), *q.GetImaginary()])
        own = numbers(row, ["qw", "qx", "qy", "qz"])
        check(abs(abs(q @ own) - 1) < 1e-5, "another orientation")
        sizes = UsdGeom.Imageable(prim).ComputeLocalBound(stage.GetEndTimeCode(), "default")
        check(not sizes.GetRange().IsEmpty(), "no extent")
    return f"USD: {len(validators)} validators, {len(moved)} bodies, {len(drawn)} shapes"


def vtk():
    reader = pyvista.get_reader(folder / f"{name}.pvd")
    check(np.allclose(reader.time_values, times), "other times")
    reader.set_active_time_value(times[-1])
    mesh = reader.read()[0]
    check(mesh.field_data["TimeValue"][0] == times[-1], "another time")
    for index, body in enumerate(bodies):
        own = mesh["body"] == index
        check(own.any(), f"no points of {body}")
        row = last[body]
        place, velocity, spin = (numbers(row, [axis + c for c in "xyz"]) for axis in "pvw")
        arms = mesh.points[own] - place
        check(np.allclose(mesh["velocity"][own], velocity + np.cross(spin, arms), atol=1e-3),
              "another velocity")
    check(mesh.n_cells > 0 and np.isfinite(mesh["force"]).all(), "no cells, or a force that is none")
    return f"VTK: {len(times)} frames, {mesh.n_points} points, {mesh.n_cells} cells"


def film(file, size):
    command = ["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v",
               "-show_entries", "stream=width,height,nb_read_frames,r_frame_rate,pix_fmt",
               "-of", "json", str(folder / file)]
    said = subprocess.run(command, check=True, capture_output=True, text=True)
    check(said.stderr == "", said.stderr)
    stream = json.loads(said.stdout)["streams"][0]
    check((stream["width"], stream["height"]) == size, f"{file}: {stream}")
    frames = int(stream["nb_read_frames"])
    check(abs(frames - times[-1] * 30) < 0.2 * frames + 3, f"{file}: {frames} frames")
    return f"{file}: {frames} frames"


check((folder / f"{name}.csv").read_bytes() == (folder / name / "trajectory.csv").read_bytes(), "other rows")
check(pyvista.read(folder / f"{name}.png").dimensions[:2] == (640, 400), "another size of picture")
for line in [usd(), vtk(), film(f"{name}.gif", (400, 250)), film(f"{name}.mp4", (400, 252))]:
    print(line)
