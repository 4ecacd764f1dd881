"""Cases of glTF (Khronos Group, glTF 2.0 Specification)."""

import base64
import json
import struct

from case import CORNERS, FACES, REFUSED, TETRAHEDRON, Case, Facts, moved

POINTS = struct.pack("<12f", *(x for corner in CORNERS for x in corner))
INDICES = [i for face in FACES for i in face]
CODE = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}


def pack(code, values):
    return struct.pack(f"<{len(values)}{CODE[code]}", *values)


class Document:
    """A document under construction; without changes, the tetrahedron in one node."""

    def __init__(self, points=POINTS, indices=INDICES, code=5123, **primitive):
        self.data = b""
        self.json = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "accessors": [], "bufferViews": [],
        }
        primitive.setdefault("attributes", {})["POSITION"] = self.accessor(points, 5126, len(points) // 12, "VEC3", CORNERS)
        if indices is not None:
            primitive["indices"] = self.accessor(pack(code, indices), code, len(indices), "SCALAR")
        self.json["meshes"] = [{"primitives": [primitive]}]

    def view(self, data, **more):
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more})
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, data, code, count, kind, bounded=None, stride=None, **more):
        view = self.view(data, **({"byteStride": stride} if stride else {}))
        entry = {"bufferView": view, "componentType": code, "count": count, "type": kind, **more}
        if bounded:
            entry["min"], entry["max"] = ([f(p[i] for p in bounded) for i in range(3)] for f in (min, max))
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def change(self, **entries):
        """Sets or, with None, removes entries of the JSON."""
        for key, value in entries.items():
            if value is None:
                self.json.pop(key, None)
            else:
                self.json[key] = value
        return self

    def gltf(self, uri=None):
        uri = uri or "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        return json.dumps({**self.json, "buffers": [{"byteLength": len(self.data), "uri": uri}]}).encode()

    def glb(self, padded=True, pad=b" ", more=b"", version=2):
        text = json.dumps({**self.json, "buffers": [{"byteLength": len(self.data)}]}).encode()
        text += pad * (-len(text) % 4) if padded else (b" " if len(text) % 4 == 0 else b"")
        data = self.data + bytes(-len(self.data) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data + more
        return struct.pack("<4sII", b"glTF", version, 12 + len(chunks)) + chunks


def case(name, document, expected=TETRAHEDRON, rule="", extension="gltf", sides=None):
    content = document.gltf() if isinstance(document, Document) else document
    return Case("gltf " + name, extension, content, expected, rule, sides or {})


def nodes(*entries, roots=(0,)):
    return Document().change(nodes=list(entries), scenes=[{"nodes": list(roots)}])


def interleaved():
    document = Document()
    data = b"".join(struct.pack("<6f", *corner, 0, 0, 1) for corner in CORNERS)
    document.json["meshes"][0]["primitives"][0]["attributes"] = {"POSITION": document.accessor(data, 5126, 4, "VEC3", CORNERS, 24)}
    return document


def second_of_view():
    """Positions that begin within their view, at the byteOffset of the accessor."""
    document = Document()
    position = document.accessor(bytes(24) + POINTS, 5126, 4, "VEC3", CORNERS, byteOffset=24)
    document.json["meshes"][0]["primitives"][0]["attributes"] = {"POSITION": position}
    return document


def zeros():
    document = Document()
    del document.json["accessors"][0]["bufferView"]
    return document


def beyond_view():
    """An accessor of four positions in a view of three."""
    document = Document()
    document.json["bufferViews"][0]["byteLength"] = 36
    return document


def sparse(with_view):
    document = Document()
    where = document.view(pack(5121, [1, 3]))
    values = document.view(struct.pack("<6f", *CORNERS[1], *CORNERS[3]))
    entry = document.json["accessors"][0]
    entry["sparse"] = {"count": 2, "indices": {"bufferView": where, "componentType": 5121}, "values": {"bufferView": values}}
    base = [CORNERS[0], (7.0, 7.0, 7.0), CORNERS[2], (8.0, 8.0, 8.0)] if with_view else None
    if base:
        entry["bufferView"] = document.view(struct.pack("<12f", *(x for corner in base for x in corner)))
    else:
        # zeros where nothing is replaced: corner 2 is replaced as well
        del entry["bufferView"]
        entry["sparse"]["count"] = 3
        entry["sparse"]["indices"]["bufferView"] = document.view(pack(5121, [1, 2, 3]))
        entry["sparse"]["values"]["bufferView"] = document.view(struct.pack("<9f", *CORNERS[1], *CORNERS[2], *CORNERS[3]))
    return document


def quantised(normalised):
    document = Document()
    # 32766 can be divided by 3, 32767 cannot
    unit = 32766 if normalised else 100
    # four numbers per vertex, since a stride is a multiple of 4 bytes
    data = b"".join(pack(5122, [*(round(x / 3 * unit) if normalised else int(x * unit) for x in corner), 0]) for corner in CORNERS)
    scale = 3.0 * 32767 / 32766 if normalised else 0.01
    bounds = [tuple(round(x / 3 * unit) if normalised else int(x * unit) for x in corner) for corner in CORNERS]
    position = document.accessor(data, 5122, 4, "VEC3", bounds, 8, normalized=normalised)
    document.json["meshes"][0]["primitives"][0]["attributes"] = {"POSITION": position}
    extension = ["KHR_mesh_quantization"]
    return document.change(nodes=[{"mesh": 0, "scale": [scale] * 3}], extensionsUsed=extension, extensionsRequired=extension)


def primitives(*entries):
    """Primitives that share the positions: pairs of mode and indices."""
    document = Document()
    position = document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    document.json["meshes"][0]["primitives"] = [
        {"attributes": {"POSITION": position}, "mode": mode, "indices": document.accessor(pack(5121, i), 5121, len(i), "SCALAR")}
        for mode, i in entries
    ]
    return document


def morphed(**where):
    """A morph target moves corner 1 by 1 along x; `where` gives its weight in the mesh or the node."""
    document = Document()
    shift = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    target = document.accessor(struct.pack("<12f", *(x for s in shift for x in s)), 5126, 4, "VEC3", shift)
    document.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": target}]
    document.json["meshes"][0].update(where.get("mesh", {}))
    document.json["nodes"][0].update(where.get("node", {}))
    return document


def skinned(scale=1.0, joint=(1.0, 0.0, 0.0)):
    """All corners follow a joint that was bound at (1, 0, 0), under a parent of this scale. The node of the mesh is elsewhere."""
    document = Document()
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = document.accessor(pack(5121, [0] * 16), 5121, 4, "VEC4")
    attributes["WEIGHTS_0"] = document.accessor(pack(5126, [1, 0, 0, 0] * 4), 5126, 4, "VEC4")
    bind = document.accessor(pack(5126, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1]), 5126, 1, "MAT4")
    entries = [{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {"scale": [scale] * 3, "children": [2]}, {"translation": list(joint)}]
    skin = [{"joints": [2], "inverseBindMatrices": bind}]
    return document.change(nodes=entries, scenes=[{"nodes": [0, 1]}], skins=skin)


def compressed(extension, required):
    document = Document()
    document.json["meshes"][0]["primitives"][0]["extensions"] = {extension: {"bufferView": 0, "attributes": {"POSITION": 0}}}
    if required:
        for accessor in document.json["accessors"]:
            del accessor["bufferView"]
        document.change(extensionsRequired=[extension])
    return document.change(extensionsUsed=[extension])


GLTF1 = json.dumps({
    "asset": {"version": "1.0"}, "scene": "s", "scenes": {"s": {"nodes": ["n"]}}, "nodes": {"n": {"meshes": ["m"]}},
    "meshes": {"m": {"primitives": []}}, "accessors": {}, "bufferViews": {}, "buffers": {},
}).encode()
SOUP = b"".join(struct.pack("<3f", *CORNERS[i]) for i in INDICES)
TURN = {"rotation": [0.0, 0.0, 2**-0.5, 2**-0.5]}  # x to y, y to −x
TURNED = Facts(4, 4, 1.0, (-2, 0, 0), (0, 1, 3))
MIRROR = Facts(4, 4, 1.0, (-1, 0, 0), (0, 2, 3))
MATRIX = [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1]  # turned, twice the size, and moved
TWO = Facts(8, 8, 2.0, (0, 0, 0), (6, 2, 3))
ROOM = [5, 5, 5]
DOUBLE = Facts(4, 4, 2.0, (0, 0, 0), (2, 2, 3))
CASES = [
    case("data URI", Document()),
    case("side file", Document().gltf("a.bin"), sides={"a.bin": Document().data}),
    case("side file, percent-encoded", Document().gltf("a%20b%C3%A4.bin"), sides={"a bä.bin": Document().data}, rule="a URI is percent-encoded UTF-8"),
    case("side file with bytes behind", Document().gltf("a.bin"), sides={"a.bin": Document().data + bytes(9)}, rule="a buffer may be longer than it says"),
    case("side file in a folder", Document().gltf("data/a.bin"), sides={"data/a.bin": Document().data}),
    case("side file `./a.bin`", Document().gltf("./a.bin"), sides={"a.bin": Document().data}),
    case("data URI of another type", Document().gltf("data:application/gltf-buffer;base64," + base64.b64encode(Document().data).decode())),
    case("byte order mark", b"\xef\xbb\xbf" + Document().gltf(), rule="must not be there; readers may ignore it"),
    case("glb", Document().glb(), extension="glb"),
    case("glb, zeros behind the JSON", Document().glb(pad=b"\0"), extension="glb", rule="must be blanks; nothing else it can mean"),
    case("glb, JSON not padded", Document().glb(padded=False), extension="glb", rule="must be padded; Blender 2.80 did not"),
    case("glb, a third chunk", Document().glb(more=struct.pack("<I4s", 4, b"XTRA") + bytes(4)), extension="glb", rule="unknown chunks are ignored"),
    case("glb, cut off", Document().glb()[:-30], REFUSED, "the file is cut off", "glb"),
    case("indices of 8 bits", Document(code=5121)),
    case("indices of 32 bits", Document(code=5125)),
    case("no indices", Document(SOUP, None)),
    case("strip", Document(indices=[0, 1, 2, 3, 0, 1], mode=5), Facts(4, 4, -1.0, (0, 0, 0), (1, 2, 3)), "every second triangle is reversed"),
    case("fan", primitives((6, [0, 2, 1, 3, 2]), (4, [1, 2, 3])), rule="mode 6: all triangles share the first corner"),
    case("strip of 8-bit indices and triangles", primitives((5, [2, 1, 0, 3]), (4, [0, 3, 2, 1, 2, 3]))),
    case("points and lines as well", primitives((4, INDICES), (0, [0, 1]), (1, [0, 1]), (3, [1, 2, 3])), rule="points and lines are no surface"),
    case("degenerate triangle", Document(indices=[*INDICES, 0, 0, 1]), rule="a triangle without area encloses nothing"),
    case("translation", nodes({"mesh": 0, "translation": [5, 6, 7]}), moved((5, 6, 7))),
    case("rotation", nodes({"mesh": 0, **TURN}), TURNED),
    case("scale", nodes({"mesh": 0, "scale": [2, 2, 2]}), moved((0, 0, 0), 2)),
    case("scale, rotation and translation", nodes({"mesh": 0, "scale": [2, 2, 2], **TURN, "translation": [5, 6, 7]}), Facts(4, 4, 8.0, (1, 6, 7), (5, 8, 13)), "scaled first, moved last"),
    case("matrix", nodes({"mesh": 0, "matrix": MATRIX}), Facts(4, 4, 8.0, (1, 6, 7), (5, 8, 13)), "column by column"),
    case("mirror", nodes({"mesh": 0, "scale": [-1, 1, 1]}), MIRROR, "a negative determinant reverses the winding"),
    case("mirror by a matrix", nodes({"mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}), MIRROR, "a negative determinant reverses the winding"),
    case("two mirrors", nodes({"children": [1], "scale": [-1, 1, 1]}, {"mesh": 0, "scale": [-1, 1, 1]}), rule="the whole transform decides"),
    case("parents and children", nodes({"children": [1], "translation": [5, 0, 0]}, {"children": [2], "scale": [2, 2, 2]}, {"mesh": 0, "translation": [1, 0, 0]}), moved((7, 0, 0), 2)),
    case("two instances", nodes({"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}, roots=(0, 1)), TWO),
    case("two instances, parent and child", nodes({"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [5, 0, 0]}), TWO),
    case("node that no scene has", nodes({"mesh": 0}, {"mesh": 0, "translation": ROOM}), rule="the scene says what there is"),
    case("second scene", Document().change(scene=1, scenes=[{"nodes": [1]}, {"nodes": [0]}], nodes=[{"mesh": 0}, {"mesh": 0, "translation": ROOM}]), rule="`scene` says which is shown"),
    case("no `scene`", Document().change(scene=None), rule="with one scene there is no choice"),
    case("no scenes", Document().change(scene=None, scenes=None), rule="all nodes are roots; the specification leaves it open"),
    case("no nodes", Document().change(scene=None, scenes=None, nodes=None), rule="a library of meshes; the specification leaves it open"),
    case("interleaved", interleaved()),
    case("accessor within its view", second_of_view()),
    case("accessor without a view", zeros(), REFUSED, "its values are zero, which is no mesh"),
    case("sparse", sparse(True), rule="sparse values replace those of the view"),
    case("sparse without a view", sparse(False), rule="what is not replaced is zero"),
    case("quantised", quantised(False), rule="KHR_mesh_quantization"),
    case("quantised, normalised", quantised(True), Facts(4, 4, 1.0, (0, 0, 0), (1, 2, 3)), "KHR_mesh_quantization; c / 32767"),
    case("morph target of weight 0", morphed(mesh={"weights": [0.0]})),
    case("morph target without weights", morphed(), rule="weights are 0 unless they are given"),
    case("morph target, weight of the mesh", morphed(mesh={"weights": [1.0]}), DOUBLE, "the weights of the mesh apply"),
    case("morph target, weight of the node", morphed(mesh={"weights": [0.0]}, node={"weights": [1.0]}), DOUBLE, "the weights of the node come first"),
    case("skin, joint where it was bound", skinned(), rule="the transform of the node does not apply"),
    case("skin, joint moved", skinned(joint=(6.0, 0.0, 0.0)), moved((5, 0, 0)), "the joints move the vertices"),
    case("skin, skeleton scaled", skinned(2.0), moved((0, 0, 0), 2), "the joints move the vertices, with their parents"),
    case("unknown extension, not required", Document().change(extensionsUsed=["VENDOR_x"], extensions={"VENDOR_x": {}}), rule="may be ignored"),
    case("unknown extension, required", Document().change(extensionsUsed=["VENDOR_x"], extensionsRequired=["VENDOR_x"]), REFUSED, "must be known"),
    case("Draco, required", compressed("KHR_draco_mesh_compression", True), REFUSED, "compressed"),
    case("Draco, with plain data", compressed("KHR_draco_mesh_compression", False), rule="the plain data may be used"),
    case("meshopt, required", Document().change(extensionsUsed=["EXT_meshopt_compression"], extensionsRequired=["EXT_meshopt_compression"]), REFUSED, "compressed"),
    case("glTF 1.0", GLTF1, REFUSED, "another format"),
    case("index too large", Document(indices=[*INDICES[:-1], 4]), REFUSED, "there is no vertex 4"),
    case("accessor beyond its view", beyond_view(), REFUSED, "the bytes are another's"),
    case("buffer cut off", Document().gltf("a.bin"), REFUSED, "the file is cut off", sides={"a.bin": Document().data[:50]}),
    case("side file missing", Document().gltf("a.bin"), REFUSED, "a part is missing"),
]
