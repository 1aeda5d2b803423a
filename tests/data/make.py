#!/usr/bin/env python3
"""Writes the sample files of this folder: one small mesh in every format that vox_io reads.

Two cubes, each of five tets; formats of mixed elements get two triangles and a hexahedron as well. An
implementation of the formats of its own, so that the readers are not tested against our own writers alone.
"""
import base64
import lzma
import os
import struct
import zlib

os.chdir(os.path.dirname(os.path.abspath(__file__)))

POINTS = [(x / 2, y, z * 0.1) for x in range(3) for y in range(2) for z in range(2)]
TETS = [(0, 4, 2, 1), (6, 4, 7, 2), (5, 4, 1, 7), (3, 2, 7, 1), (4, 2, 1, 7),
        (8, 4, 9, 10), (6, 4, 10, 7), (5, 4, 7, 9), (11, 10, 9, 7), (4, 10, 7, 9)]
TRIANGLES = [(0, 1, 2), (1, 3, 2)]
HEXAHEDRA = [(0, 1, 3, 2, 4, 5, 7, 6)]
# What is in a file of mixed elements: Gmsh type, VTK type, corners.
MIXED = ([(2, 5, c) for c in TRIANGLES] + [(5, 12, c) for c in HEXAHEDRA] + [(4, 10, c) for c in TETS])


def write(name, content):
    with open(name, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())


def lines(rows):
    return "".join(" ".join(repr(x) if isinstance(x, float) else str(x) for x in row) + "\n" for row in rows)


def one_up(corners):
    return [c + 1 for c in corners]


def numbered(rows, first):
    return [(first + i, *row) for i, row in enumerate(rows)]


# ---- Gmsh ----

def gmsh_1():
    write("box_1.msh", "$NOD\n12\n" + lines(numbered(POINTS, 1)) + "$ENDNOD\n$ELM\n13\n" +
          lines((i + 1, g, 1, 1, len(c), *one_up(c)) for i, (g, _, c) in enumerate(MIXED)) + "$ENDELM\n")


def gmsh_22():
    write("box_22.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"box\"\n$EndPhysicalNames\n"
          "$Nodes\n12\n" + lines(numbered(POINTS, 1)) + "$EndNodes\n$Elements\n13\n" +
          lines((i + 1, g, 2, 1, 1, *one_up(c)) for i, (g, _, c) in enumerate(MIXED)) + "$EndElements\n")
    for order, name in (("<", "box_22_little.msh"), (">", "box_22_big.msh")):
        out = b"$MeshFormat\n2.2 1 8\n" + struct.pack(order + "i", 1) + b"\n$EndMeshFormat\n$Nodes\n12\n"
        for i, p in enumerate(POINTS):
            out += struct.pack(order + "i3d", i + 1, *p)
        out += b"\n$EndNodes\n$Elements\n13\n"
        for kind, cells in ((2, TRIANGLES), (5, HEXAHEDRA), (4, TETS)):
            out += struct.pack(order + "3i", kind, len(cells), 2)
            for i, c in enumerate(cells):
                out += struct.pack(order + "%di" % (3 + len(c)), i + 1, 1, 1, *one_up(c))
        write(name, out + b"\n$EndElements\n")


def gmsh_4():
    blocks = ((2, 2, TRIANGLES), (3, 5, HEXAHEDRA), (3, 4, TETS))
    nodes = "".join("%d\n" % (i + 1) for i in range(12)) + lines(POINTS)
    text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 12 1 12\n3 1 0 12\n" + nodes + "$EndNodes\n"
    text += "$Elements\n3 13 1 13\n"
    for dimension, kind, cells in blocks:
        text += "%d 1 %d %d\n" % (dimension, kind, len(cells)) + lines(numbered([one_up(c) for c in cells], 1))
    write("box_41.msh", text + "$EndElements\n")
    text = "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Nodes\n1 12\n1 3 0 12\n" + lines(numbered(POINTS, 1))
    text += "$EndNodes\n$Elements\n3 13\n"
    for dimension, kind, cells in blocks:
        text += "1 %d %d %d\n" % (dimension, kind, len(cells)) + lines(numbered([one_up(c) for c in cells], 1))
    write("box_40.msh", text + "$EndElements\n")

    for order, name in (("<", "little"), (">", "big")):
        head = struct.pack(order + "i", 1) + b"\n$EndMeshFormat\n$Nodes\n"
        out = b"$MeshFormat\n4.1 1 8\n" + head + struct.pack(order + "4Q3iQ", 1, 12, 1, 12, 3, 1, 0, 12)
        out += struct.pack(order + "12Q", *range(1, 13))
        for p in POINTS:
            out += struct.pack(order + "3d", *p)
        out += b"\n$EndNodes\n$Elements\n" + struct.pack(order + "4Q", 3, 13, 1, 13)
        for dimension, kind, cells in blocks:
            out += struct.pack(order + "3iQ", dimension, 1, kind, len(cells))
            for i, c in enumerate(cells):
                out += struct.pack(order + "%dQ" % (1 + len(c)), i + 1, *one_up(c))
        write("box_41_%s.msh" % name, out + b"\n$EndElements\n")

        out = b"$MeshFormat\n4 1 8\n" + head + struct.pack(order + "2Q3iQ", 1, 12, 1, 3, 0, 12)
        for i, p in enumerate(POINTS):
            out += struct.pack(order + "i3d", i + 1, *p)
        out += b"\n$EndNodes\n$Elements\n" + struct.pack(order + "2Q", 3, 13)
        for dimension, kind, cells in blocks:
            out += struct.pack(order + "3iQ", 1, dimension, kind, len(cells))
            for i, c in enumerate(cells):
                out += struct.pack(order + "%di" % (1 + len(c)), i + 1, *one_up(c))
        write("box_40_%s.msh" % name, out + b"\n$EndElements\n")


# ---- TetGen, Medit, Vega, Abaqus ----

def tetgen():
    write("box.node", "# two cubes\n12 3 1 1\n" + lines((i + 1, *p, 0.5, 1) for i, p in enumerate(POINTS)))
    write("box.ele", "10 4 1\n" + lines((i + 1, *one_up(c), 2.5) for i, c in enumerate(TETS)) + "# end\n")


def medit():
    write("box.mesh", "MeshVersionFormatted 2\n# two cubes\nDimension 3\nVertices 12\n" +
          lines((*p, 0) for p in POINTS) + "Triangles 2\n" + lines((*one_up(c), 1) for c in TRIANGLES) +
          "Hexahedra 1\n" + lines((*one_up(c), 1) for c in HEXAHEDRA) + "Corners 2\n1 12\n" +
          "Tetrahedra 10\n" + lines((*one_up(c), 1) for c in TETS) + "End\n")


def vega():
    write("box.veg", "# two cubes\n*VERTICES\n12 3 0 0\n" + lines(numbered(POINTS, 1)) +
          "*ELEMENTS\nTET\n10 4 0\n" + lines(numbered([one_up(c) for c in TETS], 1)) +
          "*MATERIAL rubber\nENU, 1000, 1e6, 0.45\n*REGION\nallElements, rubber\n")


def abaqus():
    commas = lambda rows: "".join(", ".join(map(str, row)) + "\n" for row in rows)
    write("box.inp", "*Heading\n** two cubes\n*NODE, NSET=all\n" + commas(numbered(POINTS, 1)) +
          "*ELEMENT, TYPE=CPS3, ELSET=skin\n" + commas(numbered([one_up(c) for c in TRIANGLES], 1)) +
          "*ELEMENT, TYPE=C3D8R\n" + commas(numbered([one_up(c) for c in HEXAHEDRA], 3)) +
          "*Element, type=C3D4,\nelset=body\n" + commas(numbered([one_up(c) for c in TETS], 4)) +
          "*MATERIAL, NAME=rubber\n*ELASTIC\n1e6, 0.45\n")


# ---- VTK ----

def lz4_block(data):
    """A block of LZ4, of greedy matches."""
    out, start, at, seen = b"", 0, 0, {}

    def length(number):
        return b"" if number < 15 else b"\xff" * ((number - 15) // 255) + bytes([(number - 15) % 255])

    while at + 12 < len(data):
        before, seen[data[at:at + 4]] = seen.get(data[at:at + 4]), at
        if before is None or at - before > 65535:
            at += 1
            continue
        same = 4
        while at + same < len(data) - 5 and data[before + same] == data[at + same]:
            same += 1
        out += bytes([min(at - start, 15) << 4 | min(same - 4, 15)]) + length(at - start) + data[start:at]
        out += struct.pack("<H", at - before) + length(same - 4)
        at += same
        start = at
    rest = len(data) - start
    return out + bytes([min(rest, 15) << 4]) + length(rest) + data[start:]


COMPRESSORS = {"ZLib": zlib.compress, "LZ4": lz4_block, "LZMA": lambda data: lzma.compress(data, check=lzma.CHECK_CRC32)}


def vtk():
    size = sum(1 + len(c) for _, _, c in MIXED)
    head = "# vtk DataFile Version 3.0\ntwo cubes\n%s\nDATASET UNSTRUCTURED_GRID\n"
    write("box_30.vtk", head % "ASCII" + "FIELD FieldData 1\ntime 1 1 double\n0.5\nPOINTS 12 double\n" + lines(POINTS) +
          "CELLS 13 %d\n" % size + lines((len(c), *c) for _, _, c in MIXED) + "CELL_TYPES 13\n" +
          lines((v,) for _, v, _ in MIXED) + "POINT_DATA 12\nSCALARS s float\nLOOKUP_TABLE default\n" +
          lines((0.5,) for _ in POINTS))
    out = (head % "BINARY" + "POINTS 12 float\n").encode()
    for p in POINTS:
        out += struct.pack(">3f", *p)
    out += b"\nMETADATA\nINFORMATION 0\n\nCELLS 13 %d\n" % size
    for _, _, c in MIXED:
        out += struct.pack(">%di" % (1 + len(c)), len(c), *c)
    out += b"\nCELL_TYPES 13\n" + struct.pack(">13i", *(v for _, v, _ in MIXED)) + b"\n"
    write("box_30_binary.vtk", out)

    ends = [0]
    for _, _, c in MIXED:
        ends.append(ends[-1] + len(c))
    flat = [p for _, _, c in MIXED for p in c]
    head = head.replace("3.0", "5.1")
    write("box_51.vtk", head % "ASCII" + "POINTS 12 double\n" + lines(POINTS) + "METADATA\nINFORMATION 0\n\n" +
          "CELLS 14 %d\nOFFSETS vtktypeint64\n" % len(flat) + lines([ends]) + "CONNECTIVITY vtktypeint64\n" +
          lines([flat]) + "CELL_TYPES 13\n" + lines((v,) for _, v, _ in MIXED))
    out = (head % "BINARY" + "POINTS 12 double\n").encode()
    for p in POINTS:
        out += struct.pack(">3d", *p)
    out += b"\nCELLS 14 %d\nOFFSETS vtktypeint64\n" % len(flat) + struct.pack(">14q", *ends)
    out += b"\nCONNECTIVITY vtktypeint64\n" + struct.pack(">%dq" % len(flat), *flat)
    out += b"\nCELL_TYPES 13\n" + struct.pack(">13i", *(v for _, v, _ in MIXED)) + b"\n"
    write("box_51_binary.vtk", out)


def vtu():
    ends, end = [], 0
    for _, _, c in MIXED:
        end += len(c)
        ends.append(end)
    arrays = (("Points", "Float64", "d", 3, [x for p in POINTS for x in p]),
              ("connectivity", "Int64", "q", 1, [p for _, _, c in MIXED for p in c]),
              ("offsets", "Int32", "i", 1, ends),
              ("types", "UInt8", "B", 1, [v for _, v, _ in MIXED]))

    def packed(letter, values, order, header, compressor):
        data = struct.pack(order + "%d%s" % (len(values), letter), *values)
        if not compressor:
            return [struct.pack(order + header, len(data)) + data]
        size = 64 if compressor == "ZLib" else 100
        blocks = [data[i:i + size] for i in range(0, len(data), size)]
        small = [COMPRESSORS[compressor](b) for b in blocks]
        last = len(blocks[-1]) if len(blocks[-1]) < size else 0
        return [struct.pack(order + "%d%s" % (3 + len(small), header), len(small), size, last,
                            *(len(b) for b in small)), b"".join(small)]

    def file(name, kind, order="<", header="I", compressor=None, encoding="base64"):
        attributes = 'type="UnstructuredGrid" version="1.0" byte_order="%s" header_type="%s"' % (
            "LittleEndian" if order == "<" else "BigEndian", "UInt32" if header == "I" else "UInt64")
        if compressor:
            attributes += ' compressor="vtk%sDataCompressor"' % compressor
        xml, appended = [], b""
        for array, type_name, letter, components, values in arrays:
            start = '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="%s"' % (
                type_name, array, components, kind)
            if kind == "ascii":
                xml.append(start + ">\n" + " ".join(map(repr, values)) + "\n</DataArray>\n")
                continue
            groups = packed(letter, values, order, header, compressor)
            if kind == "binary" or encoding == "base64":
                groups = [base64.b64encode(g) for g in groups]
            if kind == "binary":
                xml.append(start + ">\n" + b"".join(groups).decode() + "\n</DataArray>\n")
            else:
                xml.append(start + ' offset="%d"/>\n' % len(appended))
                appended += b"".join(groups)
        out = ('<?xml version="1.0"?>\n<VTKFile %s>\n<UnstructuredGrid>\n<Piece NumberOfPoints="12" '
               'NumberOfCells="13">\n<Points>\n%s</Points>\n<Cells>\n%s</Cells>\n</Piece>\n</UnstructuredGrid>\n' %
               (attributes, xml[0], "".join(xml[1:]))).encode()
        if kind == "appended":
            out += b'<AppendedData encoding="%s">\n_' % encoding.encode() + appended + b"\n</AppendedData>\n"
        write(name, out + b"</VTKFile>\n")

    file("box_ascii.vtu", "ascii")
    file("box_base64.vtu", "binary")
    file("box_base64_zlib.vtu", "binary", header="Q", compressor="ZLib")
    file("box_appended.vtu", "appended", encoding="raw")
    file("box_appended_zlib_big.vtu", "appended", order=">", compressor="ZLib", encoding="raw")
    file("box_appended_base64.vtu", "appended", header="Q")
    file("box_appended_base64_zlib.vtu", "appended", compressor="ZLib")
    file("box_base64_lz4.vtu", "binary", compressor="LZ4")
    file("box_appended_lzma.vtu", "appended", header="Q", compressor="LZMA", encoding="raw")


# ---- surfaces ----

def surfaces():
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    write("cube.obj", "# a unit cube of six quads, a material each, with texture coordinates\n" +
          lines(("v", *map(float, p)) for p in corners) + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n" +
          "".join("usemtl side%d\nf %s\n" % (i, " ".join("%d/%d" % (c + 1, k + 1) for k, c in enumerate(q)))
                  for i, q in enumerate(quads)))
    write("cube.off", "OFF\n8 6 0\n" + lines(corners) + lines((4, *q) for q in quads))
    write("cube.ply", "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
          "property float z\nelement face 6\nproperty list uchar int vertex_index\nend_header\n" +
          lines(corners) + lines((4, *q) for q in quads))
    triangles = [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    for order, name in (("<", "little"), (">", "big")):
        out = ("ply\nformat binary_%s_endian 1.0\ncomment with colours and labels\nelement vertex 8\n"
               "property uchar red\nproperty double x\nproperty float32 y\nproperty short z\n"
               "property list uint8 ushort labels\nelement face 6\nproperty char side\n"
               "property list int32 uint32 vertex_indices\nelement edge 1\nproperty int a\nend_header\n" % name).encode()
        for p in corners:
            out += struct.pack(order + "BdfhB2H", 255, *p, 2, 10, 11)
        for q in quads:
            out += struct.pack(order + "bi4I", 0, 4, *q)
        write("cube_%s.ply" % name, out + struct.pack(order + "i", 7))
    # The cube as strips: three sides that follow each other, and each of the others.
    write("cube_strips.ply", "ply\nformat ascii 1.0\nobj_info four strips\nelement vertex 8\nproperty float x\n"
          "property float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
          "end_header\n" + lines(corners) + "23 0 1 2 3 6 7 4 5 -1 1 5 3 7 -1 0 2 4 6 -1 0 4 1 5\n")
    out = b"a unit cube".ljust(80) + struct.pack("<I", 12)
    for t in triangles:
        out += struct.pack("<12fH", 0, 0, 0, *(float(x) for c in t for x in corners[c]), 0)
    write("cube.stl", out)
    write("cube_text.stl", "solid cube\n" + "".join(
        "  facet normal nan nan nan\n    outer loop\n" +
        "".join("      vertex %e %e %e\n" % corners[c] for c in t) + "    endloop\n  endfacet\n"
        for t in triangles) + "endsolid cube\n")
    # A scene: the same tetrahedron twice, moved by its nodes, once mirrored.
    # Five polygons and the last quad as a strip, with a line.
    ends, flat = [4 * i for i in range(6)], [c for q in quads[:5] for c in q]
    strip = [quads[5][i] for i in (0, 1, 3, 2)]
    out = b"# vtk DataFile Version 5.1\na cube\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\nunits 1 2 string\n"
    out += b"\xc2mm\x80\x64" + b"x" * 100 + b"\nPOINTS 8 float\n" + b"".join(struct.pack(">3f", *p) for p in corners)
    out += b"\nLINES 2 2\nOFFSETS vtktypeint64\n" + struct.pack(">2q", 0, 2) + b"\nCONNECTIVITY vtktypeint64\n"
    out += struct.pack(">2q", 0, 7) + b"\nPOLYGONS 6 20\nOFFSETS vtktypeint64\n" + struct.pack(">6q", *ends)
    out += b"\nCONNECTIVITY vtktypeint64\n" + struct.pack(">20q", *flat) + b"\nTRIANGLE_STRIPS 2 4\nOFFSETS vtktypeint64\n"
    write("cube.vtk", out + struct.pack(">2q", 0, 4) + b"\nCONNECTIVITY vtktypeint64\n" + struct.pack(">4q", *strip) + b"\n")
    array = '<DataArray type="%s" Name="%s" NumberOfComponents="%d" format="ascii">%s</DataArray>\n'
    write("cube.vtp", '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n<PolyData>\n<Piece NumberOfPoints="8" '
          'NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="1" NumberOfPolys="5">\n<Points>\n' +
          array % ("Float32", "Points", 3, " ".join("%d %d %d" % p for p in corners)) + "</Points>\n<Strips>\n" +
          array % ("Int32", "connectivity", 1, " ".join(map(str, strip))) + array % ("Int32", "offsets", 1, "4") +
          "</Strips>\n<Polys>\n" + array % ("Int32", "connectivity", 1, " ".join(map(str, flat))) +
          array % ("Int32", "offsets", 1, " ".join(map(str, ends[1:]))) + "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n")
    data = struct.pack("<12f12H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2)
    write("two_tetrahedra.gltf", """{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
 "nodes": [{"mesh": 0, "translation": [10, 0, 0]}, {"mesh": 0, "scale": [-2, 2, 2]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
 "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,%s"}]}
""" % base64.b64encode(data).decode())
    # The same as one file, with positions in integers and a strip.
    data = struct.pack("<16h8B", 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 1, 3, 0, 2, 0, 0)
    json = ('{"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"scenes":[{"nodes":[1]}],'
            '"nodes":[{"mesh":0,"rotation":[0,0,1,0]},{"children":[0,2],"matrix":[2,0,0,0,0,2,0,0,0,0,2,0,1,1,1,1]},'
            '{"mesh":0,"translation":[10,0,0]}],'
            '"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]}],'
            '"accessors":[{"bufferView":0,"componentType":5122,"count":4,"type":"VEC3"},'
            '{"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"}],'
            '"bufferViews":[{"buffer":0,"byteLength":32,"byteStride":8},{"buffer":0,"byteOffset":32,"byteLength":6}],'
            '"buffers":[{"byteLength":40}]}').encode()
    json += b" " * (-len(json) % 4)
    write("two_tetrahedra.glb", struct.pack("<4sII", b"glTF", 2, 28 + len(json) + len(data)) +
          struct.pack("<I4s", len(json), b"JSON") + json + struct.pack("<I4s", len(data), b"BIN\0") + data)


for make in (gmsh_1, gmsh_22, gmsh_4, tetgen, medit, vega, abaqus, vtk, vtu, surfaces):
    make()
