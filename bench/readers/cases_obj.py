"""Cases of OBJ (Wavefront, Object Files, version 3.0)."""

from case import CORNERS, FACES, REFUSED, TETRAHEDRON, Case, Facts

V = "".join(f"v {x:g} {y:g} {z:g}\n" for x, y, z in CORNERS)
F = "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in FACES)
VT = "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
VN = "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn 0 0 -1\n"

# a cube of volume 8 with quads
CUBE = [(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]

# a prism of height 2 over an arrowhead, which is concave at (1, 1); area 4 - 2 = 2
ARROW = [(0, 0), (1, 1), (2, 0), (1, 3)]


def faces(form):
    """The faces with corners such as `{0}//{0}`."""
    return "".join("f " + " ".join(form.format(i + 1) for i in face) + "\n" for face in FACES)


def cube():
    points = "".join(f"v {x} {y} {z}\n" for x, y, z in CUBE)
    return points + "".join("f " + " ".join(str(i + 1) for i in quad) + "\n" for quad in QUADS)


def arrow(start):
    """The prism; its bases begin at the corner `start`."""
    points = "".join(f"v {x} {y} {z}\n" for z in (0, 2) for x, y in ARROW)
    order = [(start + i) % 4 for i in range(4)]
    top = "f " + " ".join(str(5 + i) for i in order) + "\n"
    bottom = "f " + " ".join(str(1 + i) for i in reversed(order)) + "\n"
    sides = "".join(f"f {1 + i} {1 + (i + 1) % 4} {5 + (i + 1) % 4} {5 + i}\n" for i in range(4))
    return points + top + bottom + sides


def interleaved():
    """Each face follows copies of its vertices and counts them from the end."""
    text = ""
    for face in FACES:
        text += "".join("v {:g} {:g} {:g}\n".format(*CORNERS[i]) for i in face) + "f -3 -2 -1\n"
    return text


def case(name, text, expected=TETRAHEDRON, rule="", encoding="utf-8"):
    content = text if isinstance(text, bytes) else text.encode(encoding)
    return Case("obj " + name, "obj", content, expected, rule)


ARROW_FACTS = Facts(8, 12, 4.0, (0, 0, 0), (2, 3, 2))
# the second object has its x coordinates at 10 and 11; counting its vertices from the end turns no face around
TWO = Facts(8, 8, 2.0, (0, 0, 0), (11, 2, 3))
CASES = [
    case("plain", V + F),
    case("`v/vt`", V + VT + faces("{0}/{0}")),
    case("`v//vn`", V + VN + faces("{0}//{0}")),
    case("`v/vt/vn`", V + VT + VN + faces("{0}/{0}/{0}")),
    case("`v//vn` with other indices", V + VN + faces("{0}//2"), rule="each index counts its own list"),
    case("trailing slash `1/`", V + faces("{0}/"), rule="not in the specification: no texture is what it can mean"),
    case("negative indices", V + "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n", rule="−1 is the vertex read last"),
    case("negative indices between vertices", interleaved(), rule="−1 is the vertex read last"),
    case("`l` and `p`", V + "l 1 2 3\np 4\n" + F, rule="lines and points are no faces"),
    case("continued face", V + F.replace("f 1 3 2", "f 1 \\\n3 \\\n2"), rule="a backslash joins lines"),
    case("continued vertex", V.replace("v 0 2 0", "v 0 \\\n 2 0") + F, rule="a backslash joins lines"),
    case("groups, materials, smoothing", "mtllib none.mtl\no a\n" + V + "g x y\nusemtl m\ns off\n" + F + "g\n", rule="a missing library changes no geometry"),
    case("two objects", "o a\n" + V + F + "o b\n" + V.replace("v ", "v 1") + faces("-{0}"), TWO, "all objects belong to the file"),
    case("CR LF", (V + F).replace("\n", "\r\n")),
    case("CR", (V + F).replace("\n", "\r"), rule="line ends of old Macintosh files; not in the specification"),
    case("byte order mark", "\ufeff" + V + F, rule="not in the specification; editors write it"),
    case("Latin-1 name", "o Würfel\n# é\n" + V + F, encoding="latin-1", rule="names have no stated encoding"),
    case("comments", "# a\n" + V.replace("v 0 2 0", "v 0 2 0 # b") + "\n  # c\n" + F, rule="a comment may end any line"),
    case("comment behind a face", V + F.replace("\n", " # a\n"), rule="a comment may end any line"),
    case("comment without a blank", V + F.replace("\n", "#a\n"), REFUSED, "a word may have this character"),
    case("polygon that repeats its first corner", V + F.replace("f 1 3 2", "f 1 3 2 1"), rule="the repeated corner adds no area"),
    case("decimal comma", V.replace("v 0 2 0", "v 0 2,0 0") + F, REFUSED, "not a number"),
    case("index `1.0`", V + F.replace("f 1 3 2", "f 1.0 3 2"), REFUSED, "an index is a whole number"),
    case("tabs and blanks", "  " + V.replace(" ", "\t  ") + "\n \n" + F.replace("f ", "  f   "), rule="white space separates words"),
    case("no line break at the end", (V + F).rstrip()),
    case("quads", cube(), Facts(8, 12, 8.0, (0, 0, 0), (2, 2, 2))),
    case("concave polygon", arrow(0), ARROW_FACTS),
    case("concave polygon, from its notch", arrow(1), ARROW_FACTS),
    case("weights `x y z 1`", V.replace("\n", " 1\n") + F, rule="the weight is for rational curves only"),
    case("weights `x y z 2`", V.replace("\n", " 2\n") + F, rule="the weight is for rational curves only"),
    case("colours `x y z r g b`", V.replace("\n", " 0.5 0.25 1\n") + F, rule="not in the specification; common"),
    case("weight and colour", V.replace("\n", " 1 0.5 0.25 1\n") + F, rule="not in the specification"),
    case("number forms", "v +0 -0. 0e0\nv 1.0E+0 .0 0\nv 0 2. 0\nv 0 0 30e-1\n" + F, rule="all are decimal numbers"),
    case("`V` and `F`", V.upper() + F.upper(), rule="not in the specification: there is nothing else they can mean"),
    case("`fo` for `f`", V + F.replace("f ", "fo "), rule="`fo` is obsolete and is read as `f`"),
    case("faces before vertices", F + V, rule="indices count all vertices of the file"),
    case("vertex that no face uses", V + "v 9 9 9\n" + F, Facts(5, 4, 1.0, (0, 0, 0), (9, 9, 9)), "the vertex is in the file"),
    case("seam: vertices twice", V + V + F.replace("f 2 3 4", "f 6 7 8")),
    case("repeated corner", V + F + "f 1 1 2\n", rule="a face without area encloses nothing"),
    case("double precision", V.replace("v 1 0 0", "v 1.0000000001 0 0") + V + F.replace("f 2 3 4", "f 6 3 4"), Facts(5, 4, 1.0, (0, 0, 0), (1.0000000001, 2, 3)), "the numbers differ in the file"),
    case("index 0", V + F + "f 0 1 2\n", REFUSED, "indices count from 1"),
    case("index too large", V + F + "f 1 2 5\n", REFUSED, "there is no vertex 5"),
    case("negative index too large", V + F + "f -1 -2 -5\n", REFUSED, "there are four vertices before it"),
    case("face of two corners", V + F + "f 1 2\n", REFUSED, "a face has three corners or more"),
    case("vertex of two numbers", V.replace("v 0 2 0", "v 0 2") + F, REFUSED, "a vertex has x, y and z"),
    case("NaN", V.replace("v 0 2 0", "v 0 nan 0") + F, REFUSED, "not a number"),
    case("curved surface", V + F + "cstype bspline\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n", REFUSED, "a part would be missing"),
]
