"""Reads mesh files with one library and prints a line of JSON for each: `readers.py LIBRARY FILE…`."""

import json
import sys

import numpy as np


def with_trimesh(path):
    import trimesh

    mesh = trimesh.load(path, process=False, skip_materials=True)
    if isinstance(mesh, trimesh.Scene):
        mesh = mesh.to_mesh()
    faces = getattr(mesh, "faces", np.zeros((0, 3), int))
    return np.asarray(mesh.vertices), np.asarray(faces)


def with_meshio(path):
    import meshio

    mesh = meshio.read(path)
    triangles = []
    for block in mesh.cells:
        if block.type in ("triangle", "quad", "polygon"):
            triangles += [t for face in block.data for t in fan(face)]
    # what follows x, y and z is a weight or a colour
    return mesh.points[:, :3], np.array(triangles, int).reshape(-1, 3)


def with_vtk(path):
    import vtk

    kind = path.rsplit(".", 1)[1]
    readers = {"obj": vtk.vtkOBJReader, "stl": vtk.vtkSTLReader, "ply": vtk.vtkPLYReader}
    reader = readers.get(kind, vtk.vtkGLTFReader)()
    messages = []
    for source in (reader, vtk.vtkOutputWindow.GetInstance()):
        source.AddObserver("ErrorEvent", lambda *_: messages.append("error"))
    if kind == "stl":
        reader.MergingOff()
    reader.SetFileName(path)
    reader.Update()
    output = reader.GetOutput()
    parts = [output] if isinstance(output, vtk.vtkPolyData) else polydata_of(output)
    points, triangles = [], []
    for part in parts:
        start = len(points)
        points += [part.GetPoint(i) for i in range(part.GetNumberOfPoints())]
        triangles += [[start + i for i in t] for t in triangles_of(part)]
    if messages:
        raise ValueError("the reader prints an error")
    return np.array(points, float).reshape(-1, 3), np.array(triangles, int).reshape(-1, 3)


def polydata_of(blocks):
    import vtk

    parts = []
    iterator = blocks.NewIterator()
    while not iterator.IsDoneWithTraversal():
        if isinstance(iterator.GetCurrentDataObject(), vtk.vtkPolyData):
            parts.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return parts


def triangles_of(part):
    """The triangles of polygons and strips."""
    import vtk

    triangles = []
    for i in range(part.GetNumberOfCells()):
        cell = part.GetCell(i)
        corners = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        if cell.GetCellType() == vtk.VTK_TRIANGLE_STRIP:
            triples = zip(corners, corners[1:], corners[2:])
            triangles += [(a, b, c) if k % 2 == 0 else (a, c, b) for k, (a, b, c) in enumerate(triples)]
        elif cell.GetCellDimension() == 2:
            triangles += fan(corners)
    return triangles


def fan(face):
    """A polygon as triangles. Their signed volume is that of the polygon, also where it is concave."""
    return [(face[0], b, c) for b, c in zip(face[1:], face[2:])]


def facts(points, triangles):
    """The mesh after exact welding: counts, signed volume, bounds. Triangles without three corners are dropped."""
    points = np.asarray(points, float) + 0.0
    if len(points) == 0:
        return {"error": "empty"}
    if points.shape[1] != 3:
        return {"error": "invalid"}
    if not np.isfinite(points).all():
        return {"error": "invalid"}
    # a triangle of a vertex that does not exist
    if len(triangles) and not (0 <= triangles.min() and triangles.max() < len(points)):
        return {"error": "invalid"}
    welded, new = np.unique(points, axis=0, return_inverse=True)
    corners = new.reshape(-1)[triangles]
    corners = [t for t in corners if len(set(t)) == 3]
    a, b, c = (welded[[t[k] for t in corners]] if corners else np.zeros((0, 3)) for k in range(3))
    volume = float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0) if corners else 0.0
    return {
        "vertices": len(welded), "triangles": len(corners), "volume": volume,
        "bounds": [welded.min(axis=0).tolist(), welded.max(axis=0).tolist()],
    }


def main():
    library, paths = sys.argv[1], sys.argv[2:]
    read = {"trimesh": with_trimesh, "meshio": with_meshio, "VTK": with_vtk}[library]
    for path in paths:
        try:
            found = facts(*read(path))
        except (Exception, SystemExit) as error:
            found = {"error": (str(error) or type(error).__name__).splitlines()[0]}
        print("facts " + json.dumps({"file": path, "facts": found}), flush=True)


if __name__ == "__main__":
    main()
