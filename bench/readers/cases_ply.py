"""Cases of PLY (Greg Turk, The PLY Polygon File Format, and the files of the Stanford repository)."""

import struct

from case import CORNERS, FACES, REFUSED, TETRAHEDRON, Case, Facts

XYZ = ["float x", "float y", "float z"]
LIST = ["list uchar int vertex_indices"]
CODES = {
    "char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
    "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f", "float64": "d",
}


def header(encoding, elements, extra=""):
    text = f"ply\nformat {encoding} 1.0\n{extra}"
    for name, properties, rows in elements:
        text += f"element {name} {len(rows)}\n" + "".join(f"property {p}\n" for p in properties)
    return text + "end_header\n"


def text_rows(elements):
    lines = []
    for _, _, rows in elements:
        for row in rows:
            fields = [f"{len(v)} " + " ".join(f"{x:g}" for x in v) if isinstance(v, (list, tuple)) else f"{v:g}" for v in row]
            lines.append(" ".join(fields).strip() + "\n")
    return "".join(lines)


def binary_rows(elements, order):
    data = b""
    for _, properties, rows in elements:
        for row in rows:
            for declared, value in zip(properties, row):
                words = declared.split()
                if words[0] == "list":
                    data += struct.pack(order + CODES[words[1]], len(value))
                    data += struct.pack(f"{order}{len(value)}{CODES[words[2]]}", *value)
                else:
                    code = CODES[words[0]]
                    data += struct.pack(order + code, value if code in "fd" else int(value))
    return data


def ply(elements, encoding="ascii", extra=""):
    start = header(encoding, elements, extra).encode()
    if encoding == "ascii":
        return start + text_rows(elements).encode()
    return start + binary_rows(elements, "<" if encoding == "binary_little_endian" else ">")


def vertices(properties=None, more=()):
    return ("vertex", properties or XYZ, [tuple(corner) + tuple(more) for corner in CORNERS])


def faces(properties=None, more=()):
    return ("face", properties or LIST, [(list(face), *more) for face in FACES])


BASIC = [vertices(), faces()]
LITTLE, BIG = "binary_little_endian", "binary_big_endian"
TEXT = ply(BASIC)
CAMERA = ("camera", ["float a", "list uchar float matrix", "uchar b"], [(1.5, [1, 2, 3], 7), (2.5, [], 8)])
EDGES = ("edge", ["int vertex1", "int vertex2"], [(0, 1), (1, 2)])
COLOURED = vertices([*XYZ, "uchar red", "uchar green", "uchar blue"], (1, 2, 3))
SCRAMBLED = ("vertex", ["float z", "uchar red", "float x", "float nx", "float y"], [(z, 9, x, 0.5, y) for x, y, z in CORNERS])
# the first byte of the data is that of a line break
NUMBERED = [("vertex", ["uchar number", *XYZ], [(10, *corner) for corner in CORNERS]), faces()]
STRIP = ("tristrips", LIST, [([0, 1, 2, 3, 0, 1],)])  # the four faces of a tetrahedron
RESTART = ("tristrips", LIST, [([0, 2, 1, -1, 0, 1, 3, -1, 0, 3, 2, -1, 1, 2, 3, -1],)])
SQUARES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = [("vertex", XYZ, [(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)]), ("face", LIST, [(list(q),) for q in SQUARES])]


def case(name, content, expected=TETRAHEDRON, rule=""):
    return Case("ply " + name, "ply", content, expected, rule)


def both(name, elements, expected=TETRAHEDRON, rule=""):
    """A case in text and one in binary."""
    return [case(f"text, {name}", ply(elements), expected, rule), case(f"binary, {name}", ply(elements, LITTLE), expected, rule)]


CASES = [
    case("text", TEXT),
    case("little-endian", ply(BASIC, LITTLE)),
    case("big-endian", ply(BASIC, BIG)),
    case("text, CR LF", TEXT.replace(b"\n", b"\r\n")),
    case("text, CR", TEXT.replace(b"\n", b"\r"), rule="the specification ends lines with CR"),
    case("binary, CR LF in the header", header(LITTLE, BASIC).replace("\n", "\r\n").encode() + binary_rows(BASIC, "<"), rule="programs write it; the specification has CR"),
    case("binary, CR in the header", header(LITTLE, BASIC).replace("\n", "\r").encode() + binary_rows(BASIC, "<"), rule="the specification ends lines with CR"),
    case("binary, CR in the header, first byte 10", header(LITTLE, NUMBERED).replace("\n", "\r").encode() + binary_rows(NUMBERED, "<"), rule="the specification ends lines with CR"),
    case("binary, first byte 10", ply(NUMBERED, LITTLE)),
    case("blanks behind the words of the header", TEXT.replace(b"end_header\n", b"end_header \n").replace(b"float x\n", b"float  x \n"), rule="white space separates words"),
    case("no faces, but the element", ply([vertices(), ("face", LIST, [])], LITTLE), Facts(4, 0, 0.0, (0, 0, 0), (1, 2, 3)), "a cloud of points"),
    case("comments and obj_info", ply(BASIC, "ascii", "comment a\ncomment\nobj_info n 3\ncomment element vertex 9\n")),
    case("binary, comments and obj_info", ply(BASIC, BIG, "comment a\nobj_info n 3\n")),
    case("comment before `format`", TEXT.replace(b"ply\n", b"ply\ncomment first\n"), rule="comments stand anywhere in the header"),
    case("comment in Latin-1", TEXT.replace(b"ply\n", "ply\ncomment Würfel\n".encode("latin-1")), rule="comments have no stated encoding"),
    *both("element before the vertices", [CAMERA, *BASIC], rule="unknown elements are skipped"),
    *both("element behind the faces", [*BASIC, CAMERA], rule="unknown elements are skipped"),
    *both("element between", [vertices(), EDGES, faces()], rule="unknown elements are skipped"),
    *both("faces before vertices", [faces(), vertices()], rule="elements stand in the order of the header"),
    *both("colours", [COLOURED, faces()]),
    *both("properties in another order", [SCRAMBLED, faces()], rule="properties are found by their names"),
    *both("doubles", [vertices(["double x", "double y", "double z"]), faces()]),
    *both("whole numbers", [vertices(["int x", "short y", "uchar z"]), faces()], rule="a coordinate may have any type"),
    *both("names int8 to float64", [vertices(["float64 x", "float32 y", "int16 z"]), faces(["list uint8 uint32 vertex_indices"])], rule="the newer names of the types"),
    *both("`vertex_index`", [vertices(), faces(["list uchar int vertex_index"])], rule="the older of the two names"),
    *both("counts of type int", [vertices(), faces(["list int int vertex_indices"])]),
    *both("indices of type uchar", [vertices(), faces(["list uchar uchar vertex_indices"])]),
    *both("indices of type ushort", [vertices(), faces(["list ushort ushort vertex_indices"])], rule="a list may have any types"),
    *both("indices of type uint", [vertices(), faces(["list uint uint vertex_indices"])]),
    *both("properties of faces before the list", [vertices(), ("face", ["uchar flag", "float a", *LIST], [(1, 0.5, list(f)) for f in FACES])], rule="properties are found by their names"),
    *both("properties of faces behind the list", [vertices(), faces([*LIST, "uchar red", "list uchar float texcoord"], (7, [0, 1, 0.5, 1, 0, 0]))], rule="unknown properties are skipped"),
    *both("list in the vertices", [vertices([*XYZ, "list uchar int tags"], ([5, 6],)), faces()], rule="unknown lists are skipped"),
    *both("quads", CUBE, Facts(8, 12, 8.0, (0, 0, 0), (2, 2, 2))),
    *both("triangle strip", [vertices(), STRIP], Facts(4, 4, -1.0, (0, 0, 0), (1, 2, 3)), "tristrips of the Stanford repository: every second triangle is reversed"),
    *both("triangle strips with −1", [vertices(), RESTART], rule="tristrips of the Stanford repository: −1 ends a strip"),
    *both("no faces", [vertices()], Facts(4, 0, 0.0, (0, 0, 0), (1, 2, 3)), "a cloud of points"),
    case("text, number forms", TEXT.replace(b"1 0 0\n", b"+1. .0 -0e0\n", 1), rule="all are decimal numbers"),
    case("text, one value per line", header("ascii", BASIC).encode() + text_rows(BASIC).replace(" ", "\n").encode(), REFUSED, "each element has a line of its own"),
    case("text, blanks at the ends of lines", TEXT.replace(b"\n3 ", b" \n  3 ")),
    case("text, no line break at the end", TEXT.rstrip()),
    case("text, double precision", ply([("vertex", ["double x", "double y", "double z"], [*CORNERS, (1.0, 0.0, 0.0)]), ("face", LIST, [([0, 2, 1],), ([0, 1, 3],), ([0, 3, 2],), ([4, 2, 3],)])]).replace(b"1 0 0\n", b"1.0000000001 0 0\n", 1), Facts(5, 4, 1.0, (0, 0, 0), (1.0000000001, 2, 3)), "the numbers differ in the file"),
    case("text, vertex that no face uses", ply([("vertex", XYZ, [*CORNERS, (9, 9, 9)]), faces()]), Facts(5, 4, 1.0, (0, 0, 0), (9, 9, 9)), "the vertex is in the file"),
    case("index too large", ply([vertices(), ("face", LIST, [([0, 1, 4],)])], LITTLE), REFUSED, "there is no vertex 4"),
    case("negative index", ply([vertices(), ("face", LIST, [([0, 1, -1],)])], LITTLE), REFUSED, "vertices count from 0"),
    case("face of two corners", ply([vertices(), ("face", LIST, [([0, 1],)])], LITTLE), REFUSED, "a face has three corners or more"),
    case("cut off, text", TEXT[:-20], REFUSED, "the file is cut off"),
    case("cut off, binary", ply(BASIC, LITTLE)[:-6], REFUSED, "the file is cut off"),
    case("bytes behind the last element", ply(BASIC, LITTLE) + b"\x01\x02\x03\x04" * 4, REFUSED, "the counts are wrong"),
    case("NaN", TEXT.replace(b"1 0 0\n", b"nan 0 0\n", 1), REFUSED, "not a number"),
    case("no z", ply([("vertex", ["float x", "float y"], [(0, 0), (1, 0), (0, 2)]), ("face", LIST, [([0, 1, 2],)])]), REFUSED, "a vertex has x, y and z"),
]
