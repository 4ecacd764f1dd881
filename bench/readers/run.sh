#!/usr/bin/env bash
# Compares the readers of mesh files with those of trimesh, meshio and VTK, and prints docs/readers.md:
#     bench/readers/run.sh > docs/readers.md
# Needs Rust, Python 3 with venv, and the network for the first run. MESH_FACTS is a built example of that name (default:
# build it).
set -euo pipefail
cd "$(dirname "$0")"

venv=$PWD/.venv
if [ ! -x "$venv/bin/python" ]; then python3 -m venv "$venv"; fi
"$venv/bin/pip" install --quiet --disable-pip-version-check -r requirements.txt >&2
facts=${MESH_FACTS:-}
if [ -z "$facts" ]; then
    cargo build --release --locked -p tumble-io --example mesh_facts --manifest-path ../../Cargo.toml >&2
    facts=${CARGO_TARGET_DIR:-$PWD/../../target}/release/examples/mesh_facts
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PYTHONDONTWRITEBYTECODE=1

cat <<'PAGE'
# Readers of mesh files, compared

`bench/readers/run.sh > docs/readers.md` generates this page. It writes small files, each with one peculiarity, and reads them with
tumble, [trimesh](https://trimesh.org), [meshio](https://github.com/nschloe/meshio) and [VTK](https://vtk.org), each with its defaults.
The files are in `bench/readers/cases_*.py`.

The column *holds* says what is in the file by the specification of its format: vertices after exact welding, triangles, and signed
volume, or *refused* where any mesh would be a wrong one. It was written by hand, not by a program. Where the specification
is silent or a file breaks it, it is the only mesh that the file can mean, and the column *rule* says so. tumble's readers were made to agree with it, so
the other columns are of more interest: where two of them differ, a file that one program wrote may be another body in the next.

- ✓: the program finds these counts, volume and bounds, or refuses the file where it should.
- *refused*: the program reports an error. *empty*: it reads nothing, which passes where the file should be refused.
- *invalid*: it returns a mesh that is none: with NaN, or with a triangle of vertices that do not exist.
- Otherwise the difference is named. Bounds and volumes are equal within 1e-6, because VTK keeps single precision.

meshio does not read glTF. Most of its refusals of STL and PLY are of what it does not support, which is no fault.

PAGE
"$venv/bin/python" compare.py "$(realpath "$facts")" "$scratch"
