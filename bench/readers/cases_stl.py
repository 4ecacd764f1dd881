"""Cases of STL (3D Systems, StereoLithography Interface Specification)."""

import struct

from case import CORNERS, FACES, REFUSED, TETRAHEDRON, Case, Facts, moved


def facets(form="{:g}", corners=CORNERS, normal="0 0 0"):
    text = ""
    for face in FACES:
        text += f"facet normal {normal}\n outer loop\n"
        for i in face:
            text += "  vertex " + " ".join(form.format(x) for x in corners[i]) + "\n"
        text += " endloop\nendfacet\n"
    return text


TEXT = "solid a\n" + facets() + "endsolid a\n"


def binary(header=b"", count=4, normal=(0.0, 0.0, 0.0), attribute=0, tail=b"", corners=CORNERS):
    content = header.ljust(80, b"\0")[:80] + struct.pack("<I", count)
    for face in FACES:
        numbers = [*normal, *(x for i in face for x in corners[i])]
        content += struct.pack("<12fH", *numbers, attribute)
    return content + tail


def case(name, content, expected=TETRAHEDRON, rule=""):
    content = content if isinstance(content, bytes) else content.encode("latin-1")
    return Case("stl " + name, "stl", content, expected, rule)


SHIFTED = [(x + 5, y, z) for x, y, z in CORNERS]
NAN = float("nan")
BOTH = Facts(8, 8, 2.0, (0, 0, 0), (6, 2, 3))
LOOSE = "not in the specification: nothing else it can mean"
CASES = [
    case("text", TEXT),
    case("text, CR LF", TEXT.replace("\n", "\r\n")),
    case("text, CR", TEXT.replace("\n", "\r"), rule="white space separates words"),
    case("text, capitals", TEXT.upper(), rule=LOOSE),
    case("text, `end loop` and `end facet`", TEXT.replace("endloop", "end loop").replace("endfacet", "end facet"), rule=LOOSE),
    case("text, one line per facet", TEXT.replace("\n ", " ").replace("\nendfacet", " endfacet"), rule="white space is free"),
    case("text, all in one line", TEXT.replace("\n", " "), rule="white space is free, but a name ends its line"),
    case("text, one word per line", "solid a\n" + facets().replace(" ", "\n") + "endsolid\n", rule="white space is free"),
    case("text, tabs", TEXT.replace(" ", "\t"), rule="white space is free"),
    case("text, no name", TEXT.replace("solid a", "solid"), rule="the name is optional"),
    case("text, name of words", TEXT.replace("solid a", "solid a facet of 3 things"), rule="the name is free text"),
    case("text, Latin-1 name", TEXT.replace("solid a", "solid Würfel"), rule="names have no stated encoding"),
    case("text, blank lines first", "\n\n  " + TEXT),
    case("text, byte order mark", b"\xef\xbb\xbf" + TEXT.encode(), rule="not in the specification; editors write it"),
    case("text, several solids", TEXT + "solid b\n" + facets(corners=SHIFTED) + "endsolid b\n", BOTH, "all solids belong to the file"),
    case("text, number forms", "solid a\n" + facets("{:+.3E}") + "endsolid a\n"),
    case("text, numbers `1.` and `.5`", TEXT.replace("vertex 1 0 0", "vertex 1. .0 -.0"), rule="all are decimal numbers"),
    case("text, exponents `1e+000`", TEXT.replace("vertex 1 0 0", "vertex 1.0e+000 0.0e-000 0e0")),
    case("text, NaN normals", "solid a\n" + facets(normal="nan nan nan") + "endsolid a\n", rule="the corners give the normal"),
    case("text, wrong normals", "solid a\n" + facets(normal="0 0 1") + "endsolid a\n", rule="the order of the corners decides"),
    case("text, solids in one line", "solid a\n" + facets() + "endsolid a solid b\n" + facets(corners=SHIFTED) + "endsolid b\n", BOTH, "a name ends its line, unless a solid begins"),
    case("text, normals `-1.#IND`", "solid a\n" + facets(normal="-1.#IND -nan(ind) 1.#QNAN") + "endsolid a\n", rule="the corners give the normal"),
    case("text, decimal comma", TEXT.replace("vertex 1 0 0", "vertex 1,0 0 0"), REFUSED, "not a number"),
    case("text, no line break at the end", TEXT.rstrip()),
    case("text, no `endsolid`", "solid a\n" + facets(), REFUSED, "the file may be cut off"),
    case("text, cut off in a facet", TEXT[: len(TEXT) // 2], REFUSED, "the file is cut off"),
    case("text, facet of four corners", TEXT.replace("  vertex 1 0 0\n endloop", "  vertex 1 0 0\n  vertex 0 0 1\n endloop", 1), REFUSED, "a facet is a triangle"),
    case("text, word for a number", TEXT.replace("vertex 1 0 0", "vertex one 0 0"), REFUSED, "not a number"),
    case("text, double precision", TEXT.replace("vertex 1 0 0", "vertex 1.0000000001 0 0", 1), Facts(5, 4, 1.0, (0, 0, 0), (1.0000000001, 2, 3)), "the numbers differ in the file"),
    case("text, no facets", "solid a\nendsolid a\n", REFUSED, "there is no mesh"),
    case("binary", binary()),
    case("binary, header begins with `solid`", binary(b"solid made by a program"), rule="the length of the file tells"),
    case("binary, header is text with line breaks", binary(b"solid a\nfacet normal 0 0 1\n"), rule="the length of the file tells"),
    case("binary, attributes", binary(attribute=0x8001), rule="the attribute count has no agreed use"),
    case("binary, NaN normals", binary(normal=(NAN, NAN, NAN)), rule="the corners give the normal"),
    case("binary, zeros behind", binary(tail=bytes(512)), rule="the count says what is triangles"),
    case("binary, text behind", binary(tail=b"\nmade by a program\n" * 4), rule="the count says what is triangles"),
    case("binary, count 0", binary(count=0), rule="wrong; the length leaves no doubt"),
    case("binary, count 2³² − 1", binary(count=2**32 - 1), rule="wrong; the length leaves no doubt"),
    case("binary, count too small", binary(count=3), rule="wrong; the length leaves no doubt"),
    case("binary, count too large", binary(count=5), REFUSED, "the file may be cut off"),
    case("binary, cut off in a triangle", binary()[:-20], REFUSED, "the file is cut off"),
    case("binary, no triangles", binary(count=0)[:84], REFUSED, "there is no mesh"),
    case("binary, NaN corner", binary(corners=[(0, 0, 0), (NAN, 0, 0), (0, 2, 0), (0, 0, 3)]), REFUSED, "not a number"),
    case("binary, −0 for 0", binary(corners=[(-0.0, 0.0, 0.0), *CORNERS[1:]]), rule="0 and −0 are one place"),
    case("binary, far from the origin", binary(corners=[(x + 1000, y, z) for x, y, z in CORNERS]), moved((1000, 0, 0))),
]
