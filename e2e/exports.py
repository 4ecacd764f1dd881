"""Reads the files written by `tumble export` with USD, VTK and ffmpeg and compares them with trajectory.csv.

Usage: exports.py FOLDER NAME, for the run FOLDER/NAME and the exports FOLDER/NAME.*
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


def check(is_valid, problem):
    if not is_valid:
        sys.exit(f"{name}: {problem}")


def usd():
    stage = Usd.Stage.Open(str(folder / f"{name}.usda"))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    problems = UsdValidation.ValidationContext(validators).Validate(stage)
    check(not problems, [problem.GetErrorAsString() for problem in problems])
    rate = stage.GetTimeCodesPerSecond()
    check(stage.GetDefaultPrim().GetPath() == "/World", "no default prim")
    check(UsdGeom.GetStageMetersPerUnit(stage) == 1, "not in metres")
    check(np.isclose(stage.GetEndTimeCode(), times[-1] * rate), "wrong end time")
    check(UsdGeom.GetStageUpAxis(stage) == ("Z" if name == "points" else "Y"), "wrong up axis")
    moved = [prim for prim in stage.GetDefaultPrim().GetChildren() if prim.GetDisplayName() in bodies]
    check([prim.GetDisplayName() for prim in moved] == bodies, "wrong bodies")
    drawn = [prim for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies())
             if prim.IsA(UsdGeom.Gprim)]
    check(len(drawn) >= len(bodies), "missing shapes")
    for prim in moved:
        transform = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(stage.GetEndTimeCode())
        row = last[prim.GetDisplayName()]
        check(np.allclose(transform.ExtractTranslation(), numbers(row, ["px", "py", "pz"])), "wrong position")
        q = transform.ExtractRotationQuat()
        q = np.array([q.GetReal(), *q.GetImaginary()])
        expected = numbers(row, ["qw", "qx", "qy", "qz"])
        check(abs(abs(q @ expected) - 1) < 1e-5, "wrong orientation")
        sizes = UsdGeom.Imageable(prim).ComputeLocalBound(stage.GetEndTimeCode(), "default")
        check(not sizes.GetRange().IsEmpty(), "no extent")
    return f"USD: {len(validators)} validators, {len(moved)} bodies, {len(drawn)} shapes"


def vtk():
    reader = pyvista.get_reader(folder / f"{name}.pvd")
    check(np.allclose(reader.time_values, times), "wrong times")
    reader.set_active_time_value(times[-1])
    mesh = reader.read()[0]
    check(mesh.field_data["TimeValue"][0] == times[-1], "wrong time")
    for index, body in enumerate(bodies):
        own = mesh["body"] == index
        check(own.any(), f"no points of {body}")
        row = last[body]
        position, velocity, angular_velocity = (numbers(row, [axis + c for c in "xyz"]) for axis in "pvw")
        arms = mesh.points[own] - position
        check(np.allclose(mesh["velocity"][own], velocity + np.cross(angular_velocity, arms), atol=1e-3),
              "wrong velocity")
    check(mesh.n_cells > 0 and np.isfinite(mesh["force"]).all(), "no cells, or a force that is not finite")
    return f"VTK: {len(times)} frames, {mesh.n_points} points, {mesh.n_cells} cells"


def video(file, size):
    command = ["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v",
               "-show_entries", "stream=width,height,nb_read_frames,r_frame_rate,pix_fmt",
               "-of", "json", str(folder / file)]
    result = subprocess.run(command, check=True, capture_output=True, text=True)
    check(result.stderr == "", result.stderr)
    stream = json.loads(result.stdout)["streams"][0]
    check((stream["width"], stream["height"]) == size, f"{file}: {stream}")
    frames = int(stream["nb_read_frames"])
    check(abs(frames - times[-1] * 30) < 0.2 * frames + 3, f"{file}: {frames} frames")
    return f"{file}: {frames} frames"


check((folder / f"{name}.csv").read_bytes() == (folder / name / "trajectory.csv").read_bytes(), "wrong rows")
check(pyvista.read(folder / f"{name}.png").dimensions[:2] == (640, 400), "wrong image size")
for line in [usd(), vtk(), video(f"{name}.gif", (400, 250)), video(f"{name}.mp4", (400, 252))]:
    print(line)
